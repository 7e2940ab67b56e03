// SPDX-License-Identifier: BSD-3-Clause
// The edges of a triangle soup, by sorting half-edges.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// A use of an edge: the larger vertex in the upper half of the word, the half-edge in the lower.
using EdgeUse = std::uint64_t;
inline int half_edge(EdgeUse e) { return (int)(std::uint32_t)e; }

/// Calls visit(std::span<const EdgeUse>) once for every edge whose smaller vertex is at least `first` and
/// below `last`, with its half-edges of either direction, ascending. Edges come by their smaller, then their
/// larger vertex. Linear: half-edges go into the bucket of their smaller vertex, of about three.
template <class Visit>
void for_each_edge(const std::vector<Tri>& tris, int first, int last, Visit visit) {
  const int n = (int)tris.size(), n_vertices = last - first;
  std::vector<int> end(n_vertices + 1, 0);
  auto in_range = [&](int v) { return (unsigned)(v - first) < (unsigned)n_vertices; };
  for (const auto& t : tris)
    for (int v : {std::min(t[0], t[1]), std::min(t[1], t[2]), std::min(t[2], t[0])})
      if (in_range(v)) ++end[v - first + 1];
  for (int v = 0; v < n_vertices; ++v) end[v + 1] += end[v];
  std::vector<EdgeUse> use(end[n_vertices]);
  for (int t = 0; t < n; ++t) {
    const auto& [a, b, c] = tris[t];
    auto put = [&](int p, int q, int h) {
      if (const int v = std::min(p, q); in_range(v))
        use[end[v - first]++] = (EdgeUse)std::max(p, q) << 32 | (std::uint32_t)h;
    };
    put(a, b, 3 * t);
    put(b, c, 3 * t + 1);
    put(c, a, 3 * t + 2);
  }
  EdgeUse* e = use.data();
  for (int v = 0; v < n_vertices; ++v) {  // end[v] has moved to the end of bucket v
    EdgeUse* stop = use.data() + end[v];
    if (stop - e > 24) {
      std::sort(e, stop);
    } else {  // nearly all: a sort by insertion, in place
      for (EdgeUse* i = e; i < stop; ++i) {
        const EdgeUse x = *i;
        EdgeUse* j = i;
        for (; j > e && j[-1] > x; --j) *j = j[-1];
        *j = x;
      }
    }
    while (e < stop) {
      EdgeUse* f = e + 1;
      while (f < stop && *f >> 32 == *e >> 32) ++f;
      visit(std::span<const EdgeUse>(e, f));
      e = f;
    }
  }
}
/// Calls visit for all edges in this way.
template <class Visit>
void for_each_edge(const std::vector<Tri>& tris, int n_vertices, Visit visit) {
  for_each_edge(tris, 0, n_vertices, visit);
}

}  // namespace meshpipe
