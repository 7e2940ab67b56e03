// SPDX-License-Identifier: BSD-3-Clause
// Graph partitioning; the only file that sees METIS.
#pragma once
#include <vector>

namespace meshpipe {

/// An undirected graph in compressed rows: the neighbors of v are adjacency[start[v] .. start[v+1]).
struct Graph {
  std::vector<int> start, adjacency, edge_weight, vertex_weight;
};

/// Returns the part 0..k-1 of each vertex, by recursive multilevel bisection (METIS, the paper's ref. [21]);
/// the same for the same seed. imbalance: by how much a part may be heavier than the mean, such as 0.3. May
/// be called from several threads; calls wait for each other, since METIS draws from C's rand().
std::vector<int> partition_graph(const Graph& graph, int k, double imbalance, int seed);

}  // namespace meshpipe
