// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/graph.h"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>

#include "lib/core/lists.h"

namespace meshpipe {

std::vector<int> partition_graph(const Graph& graph, int k, double imbalance, int seed) {
  const int n = (int)graph.vertex_weight.size();
  if ((int)graph.start.size() != n + 1 || graph.edge_weight.size() != graph.adjacency.size() ||
      graph.start.back() != (int)graph.adjacency.size())
    throw std::logic_error("graph: rows, edges and weights do not belong together");
  if (k <= 1 || n == 0) return std::vector<int>(n, 0);
  if (k >= n) return identity(n);  // METIS is not made for parts of one vertex

  std::vector<idx_t> start(graph.start.begin(), graph.start.end());
  std::vector<idx_t> adjacency(graph.adjacency.begin(), graph.adjacency.end());
  std::vector<idx_t> edge_weight(graph.edge_weight.begin(), graph.edge_weight.end());
  std::vector<idx_t> vertex_weight(graph.vertex_weight.begin(), graph.vertex_weight.end());
  std::vector<idx_t> result(n);
  idx_t vertices = n, constraints = 1, parts = k, cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = seed;  // always given: without it METIS draws on whatever state rand() is in
  options[METIS_OPTION_NITER] = 20;
  options[METIS_OPTION_UFACTOR] = std::max<idx_t>(1, (idx_t)std::lround(1000 * imbalance));
  static std::mutex one_at_a_time;  // METIS draws from rand()
  std::lock_guard lock(one_at_a_time);
  int status = METIS_PartGraphRecursive(&vertices, &constraints, start.data(), adjacency.data(),
                                        vertex_weight.data(), nullptr, edge_weight.data(), &parts, nullptr,
                                        nullptr, options, &cut, result.data());
  if (status != METIS_OK) throw std::logic_error("graph: METIS failed with status " + std::to_string(status));
  return {result.begin(), result.end()};
}

}  // namespace meshpipe
