// SPDX-License-Identifier: BSD-3-Clause
// Junctions: where sheets meet, whose vertices are copies of each other, bit by bit at the same place.
#pragma once
#include <utility>
#include <vector>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns per vertex the first border vertex at its place, or itself where it is not on the border.
std::vector<int> first_at_border(const Connectivity& c);

/// Makes one vertex of border vertices at the same place; the others keep their order. Triangles stay, so
/// that edges may have more than two. Returns per vertex the one that it was.
std::vector<int> join_borders(Mesh& mesh);

/// Joins vertices at the same place, and returns the pairs of triangles that intersect then
/// (self_intersections), or have an edge in common that is inside the sheet of one of them: sheets may meet
/// along their borders, and touch in vertices.
std::vector<std::pair<int, int>> sheet_intersections(Mesh& mesh, const Bvh& tree);

/// Where border edges between the same two places have been cut differently, splits them until all are cut
/// at the same points. `chart`: table chart_vertex, which follows, or null. Returns the number of vertices
/// added.
int match_borders(Surface& surface, Table* chart);

}  // namespace meshpipe
