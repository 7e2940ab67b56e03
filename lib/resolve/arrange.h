// SPDX-License-Identifier: BSD-3-Clause
// The arrangement of the triangles of a mesh: pieces that meet only in common vertices and edges.
#pragma once
#include <vector>

#include "lib/resolve/exact.h"

namespace meshpipe {

/// Triangles between exact points, each with a weight: the number of sheets that lie there, those of the
/// other orientation subtracted.
struct Pieces {
  std::vector<Tri> tris;
  std::vector<int> origin;  ///< triangle of the mesh, which has the same plane and orientation
  std::vector<int> weight;
  std::vector<int> piece_of;  ///< per triangle of the mesh: one of its pieces
};

/// Divides triangles (weight: per triangle) where the pairs intersect. Pieces that coincide become one.
/// Requires: `pairs` are all that intersect; vertices differ; triangles have area.
Pieces arrange(const std::vector<Tri>& tris, const std::vector<int>& weight,
               const std::vector<std::pair<int, int>>& pairs, ExactPoints& points);

/// Unites triangles of the same vertices: the first stays; weights are added, or subtracted if opposite.
void unite_coincident(Pieces& pieces);

}  // namespace meshpipe
