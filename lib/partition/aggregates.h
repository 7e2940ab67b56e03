// SPDX-License-Identifier: BSD-3-Clause
// Groups of neighboring triangles of about equal area: a coarse model of a surface.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

struct Aggregates {
  int n = 0;
  std::vector<int> of;        ///< the aggregate of each triangle
  std::vector<int> crossing;  ///< half-edges from an aggregate to one of a higher number, sorted by the two
};

/// Grows about `wanted` connected aggregates of about equal area, breadth first; one per triangle if there
/// are no more triangles than that. `area`: per triangle.
Aggregates grow_aggregates(const Connectivity& mesh, const std::vector<double>& area, int wanted);

}  // namespace meshpipe
