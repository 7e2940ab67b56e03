// SPDX-License-Identifier: BSD-3-Clause
// The edges of a triangle soup, by sorting half-edges.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// A use of an edge: the larger vertex in the upper half of the word, the half-edge in the lower.
using EdgeUse = std::uint64_t;
inline int half_edge(EdgeUse e) { return (int)(std::uint32_t)e; }

/// Calls visit(std::span<const EdgeUse>) once for every edge, with its half-edges of either direction in
/// ascending order; edges come by smaller, then by larger vertex. Linear: half-edges go into the bucket of
/// their smaller vertex, of about three.
template <class Visit>
void for_each_edge(const std::vector<Tri>& tris, int n_vertices, Visit visit) {
  const int n = 3 * (int)tris.size();
  std::vector<int> end(n_vertices + 1, 0);
  for (int h = 0; h < n; ++h) ++end[std::min(origin(tris, h), target(tris, h)) + 1];
  for (int v = 0; v < n_vertices; ++v) end[v + 1] += end[v];
  std::vector<EdgeUse> use(n);
  for (int h = 0; h < n; ++h) {
    const int a = origin(tris, h), b = target(tris, h);
    use[end[std::min(a, b)]++] = (EdgeUse)std::max(a, b) << 32 | (std::uint32_t)h;
  }
  EdgeUse* e = use.data();
  for (int v = 0; v < n_vertices; ++v) {  // end[v] has moved to the end of bucket v
    EdgeUse* stop = use.data() + end[v];
    std::sort(e, stop);
    while (e < stop) {
      EdgeUse* f = e + 1;
      while (f < stop && *f >> 32 == *e >> 32) ++f;
      visit(std::span<const EdgeUse>(e, f));
      e = f;
    }
  }
}

}  // namespace meshpipe
