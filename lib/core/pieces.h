// SPDX-License-Identifier: BSD-3-Clause
// Connected sets of triangles.
#pragma once
#include <vector>

#include "lib/core/union_find.h"

namespace meshpipe {

/// Numbers the sets of triangles that are connected by edges for which joins(t, u) holds (t > u: the
/// triangles of the edge), in the order of their first triangles. Sets piece[t], and returns the number of
/// sets. Uses disjoint sets in the order of the triangles, which is kinder to caches than a search; in
/// parallel.
template <class Joins>
int number_pieces(const std::vector<int>& opposite, std::vector<int>& piece, const Joins& joins) {
  constexpr int chunk = 1 << 17;  // triangles
  const int n = (int)opposite.size() / 3, n_chunks = (n + chunk - 1) / chunk;
  UnionFind sets(n);
  std::vector<std::vector<int>> across(n_chunks);  // half-edges to earlier chunks
#pragma omp parallel for schedule(static) if (n_chunks > 1)
  for (int c = 0; c < n_chunks; ++c) {
    const int first = c * chunk, end = std::min(n, first + chunk);
    for (int t = first; t < end; ++t)
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int u = opposite[h] / 3;  // 0 on the border
        if (opposite[h] < 0 || u > t || !joins(t, u)) continue;
        if (u < first)
          across[c].push_back(h);
        else
          sets.join(t, u);
      }
  }
  for (const std::vector<int>& edges : across)
    for (int h : edges) sets.join(h / 3, opposite[h] / 3);
  int count = 0;
  piece.resize(n);
  for (int t = 0; t < n; ++t) {
    const int first = sets.find(t);
    piece[t] = first == t ? count++ : piece[first];
  }
  return count;
}

}  // namespace meshpipe
