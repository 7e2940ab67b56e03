// SPDX-License-Identifier: BSD-3-Clause
// How long the edges of a mesh can be where the surface is narrow.
#pragma once
#include <cstdint>
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// The longest edge there is room for at every vertex, where that is found to be below `size` (elsewhere
/// infinity, or larger than the size): a quarter of a ring, so that four edges go round it.
/// A ring is a closed line (of the border, or of edges marked in `model`, bit i of triangle t: the edge from
/// corner i to i+1; no other such edge meets it), or the shortest loop along edges that leaves a vertex and
/// comes back from the other side about a tube: its plane is across the surface, not along it. Tubes are
/// looked for at vertices where the surface bends enough for one (`curvature` per triangle), so closely that
/// every vertex of a tube is within a quarter of its ring of one. `opposite` as in lib/mesh.h.
std::vector<double> edge_room(const Mesh& mesh, const std::vector<int>& opposite,
                              const std::vector<std::uint8_t>& model, const std::vector<double>& curvature,
                              const std::vector<double>& size);

}  // namespace meshpipe
