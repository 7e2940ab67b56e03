// SPDX-License-Identifier: BSD-3-Clause
// Groups of neighbouring triangles of about equal area: a coarse model of a surface.
#pragma once
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

struct Cells {
  int n = 0;
  std::vector<int> of;        ///< the cell of each triangle
  std::vector<int> crossing;  ///< half-edges from a cell to one of a higher number, sorted by the two
};

/// Grows connected cells breadth first, about `wanted` of them, or one a triangle if there are no more
/// triangles than that. `area` is that of each triangle, `opposite` as opposite_halfedges gives it.
Cells grow_cells(const std::vector<int>& opposite, const std::vector<double>& area, int wanted);

}  // namespace meshpipe
