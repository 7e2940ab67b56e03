// SPDX-License-Identifier: BSD-3-Clause
// In which order to eliminate the rows of a symmetric sparse matrix so that it fills little.
#pragma once
#include <vector>

namespace meshpipe {

/// Where a symmetric matrix has entries off its diagonal: those of row i are in the columns
/// neighbour[start[i] .. start[i + 1]), in any order, each once.
struct Pattern {
  std::vector<int> start, neighbour;
  int rows() const { return (int)start.size() - 1; }
};

/// A permutation by approximate minimum degree: the row to be eliminated k-th.
std::vector<int> elimination_order(const Pattern& pattern);

}  // namespace meshpipe
