// SPDX-License-Identifier: BSD-3-Clause
#include "lib/ordering.h"

#include <Eigen/OrderingMethods>
#include <algorithm>

namespace meshpipe {

std::vector<int> elimination_order(const Pattern& pattern) {
  int n = pattern.rows(), k = 0;
  Eigen::SparseMatrix<char> lower(n, n);
  lower.resizeNonZeros((Eigen::Index)pattern.neighbour.size() / 2 + n);
  for (int i = 0; i < n; ++i) {
    lower.outerIndexPtr()[i] = k;
    lower.innerIndexPtr()[k++] = i;  // Eigen takes a row without a diagonal entry for a dense one
    for (int e = pattern.start[i]; e < pattern.start[i + 1]; ++e)
      if (pattern.neighbour[e] > i) lower.innerIndexPtr()[k++] = pattern.neighbour[e];
  }
  lower.outerIndexPtr()[n] = k;
  std::fill(lower.valuePtr(), lower.valuePtr() + k, 1);
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(lower.selfadjointView<Eigen::Lower>(), order);
  return {order.indices().data(), order.indices().data() + n};
}

}  // namespace meshpipe
