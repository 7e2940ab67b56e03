// SPDX-License-Identifier: BSD-3-Clause
// Junctions: where sheets meet, whose vertices are copies of each other, bit by bit at the same place.
#pragma once
#include <utility>
#include <vector>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns for each border vertex the first one with the same coordinates; for others, themselves.
std::vector<int> first_at_border(const Connectivity& c);

/// Merges border vertices with the same coordinates; vertices keep their order, triangles stay, so that edges
/// may have more than two triangles. Returns for each vertex left its former row.
std::vector<int> join_borders(Mesh& mesh);

/// Merges vertices with the same coordinates. Returns the pairs of triangles that then intersect
/// (self_intersections) or share an edge that is inside the sheet of one of them: sheets may meet along their
/// borders and touch in vertices. `tree`: of the mesh.
std::vector<std::pair<int, int>> sheet_intersections(Mesh& mesh, const Bvh& tree);

/// Splits border edges between the same two places until all are split at the same points: those at which one
/// of them was cut. `chart`: table chart_vertex, which gets rows for them, or null. Returns the number of
/// vertices added.
int match_borders(Surface& surface, Table* chart);

}  // namespace meshpipe
