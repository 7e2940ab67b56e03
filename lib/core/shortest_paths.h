// SPDX-License-Identifier: BSD-3-Clause
// Dijkstra's algorithm on any graph.
#pragma once
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace meshpipe {

/// Computes the distances of nodes from the sources by Dijkstra's algorithm, in the order of distance, ties
/// by number. `distance`: in, 0 (or an offset) for the sources and an upper bound for all others, as a rule
/// infinity. Calls visit(v, reach) once for each node v, with its final distance; it calls reach(w, d) for
/// each neighbor w, at distance d by way of v, which lowers distance[w] to d and returns true if that is
/// less. If `visit` returns bool, false ends the search.
template <class Visit>
void shortest_paths(const std::vector<int>& sources, std::vector<double>& distance, Visit visit) {
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  auto reach = [&](int v, double d) {
    if (!(d < distance[v])) return false;
    queue.push({distance[v] = d, v});
    return true;
  };
  for (int v : sources) queue.push({distance[v], v});
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v]) continue;
    if constexpr (std::is_same_v<decltype(visit(v, reach)), bool>) {
      if (!visit(v, reach)) return;
    } else {
      visit(v, reach);
    }
  }
}

}  // namespace meshpipe
