// SPDX-License-Identifier: BSD-3-Clause
// Is a map of a triangle mesh to the plane one-to-one? Proved by exact signs; and repaired where little is
// missing.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns the number of triangles whose image does not have positive orientation, by exact signs.
int count_inverted(const std::vector<Tri>& tris, const std::vector<Vec2>& uv);

/// Returns whether the images of the border loops are simple polygons that do not touch each other, one of
/// them counter-clockwise and all others clockwise (the chart on the left of each), and none flat to
/// rounding, since points of their edges are rounded, too. With count_inverted = 0 on a connected part this
/// proves the map one-to-one: a point has as many images as the loops' winding numbers around it sum up to,
/// which is then at most 1.
bool border_is_simple(const Connectivity& c, const std::vector<Vec2>& uv);

/// Returns whether a closed polygon is not empty, meets itself nowhere and runs counter-clockwise.
bool polygon_is_simple(const std::vector<Vec2>& polygon);

/// Returns for each pair of border edges that meet elsewhere than at a common end their first vertices.
std::vector<std::array<int, 2>> border_crossings(const Connectivity& c, const std::vector<Vec2>& uv);

/// Moves inner vertices of inverted triangles into the kernel of their star, in at most `sweeps` sweeps, each
/// vertex only where that leaves its star without an inverted triangle (the local cavity check of the paper's
/// part I). Border vertices do not move. Returns the number of inverted triangles that remain.
int repair_stars(const Connectivity& c, int sweeps, std::vector<Vec2>& uv);

}  // namespace meshpipe
