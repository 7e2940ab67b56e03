// SPDX-License-Identifier: BSD-3-Clause
// Is a map of a triangle mesh to the plane one-to-one? Proved by exact signs; and repaired where little is
// missing.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Number of triangles whose image does not have positive orientation.
int count_inverted(const std::vector<Tri>& tris, const std::vector<Vec2>& uv);

/// True if the loops' images are simple polygons that do not touch each other, one of them counter-clockwise
/// and all others clockwise (the chart on the left of each). Together with count_inverted = 0 on a connected
/// part of any topology this proves the map one-to-one: a point's number of images is the sum of the loops'
/// winding numbers around it, which is then at most 1.
bool border_is_simple(const Connectivity& c, const std::vector<Vec2>& uv);

/// Returns whether a closed polygon, not empty, meets itself nowhere and runs counter-clockwise.
bool polygon_is_simple(const std::vector<Vec2>& polygon);

/// Origins of the pairs of border edges that meet elsewhere than at a common end.
std::vector<std::array<int, 2>> border_crossings(const Connectivity& c, const std::vector<Vec2>& uv);

/// Moves inner vertices of inverted triangles into the kernel of their star, in at most `sweeps` sweeps, each
/// only where that leaves the star without an inverted triangle (the local cavity check of the paper's part
/// I). Border vertices do not move. Returns the number of inverted triangles that remain.
int repair_stars(const Connectivity& c, int sweeps, std::vector<Vec2>& uv);

}  // namespace meshpipe
