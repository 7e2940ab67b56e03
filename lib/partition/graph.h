// SPDX-License-Identifier: BSD-3-Clause
// Graph partitioning; the only file that sees METIS.
#pragma once
#include <vector>

namespace meshpipe {

/// An undirected graph in compressed rows: neighbors of v are adjacency[start[v] .. start[v+1]), each edge
/// twice.
struct Graph {
  std::vector<int> start, adjacency, edge_weight, vertex_weight;
};

/// Recursive multilevel bisection into `k` parts (METIS, the paper's ref. [21]); deterministic for a seed.
/// May be called from several threads; METIS draws from C's rand(), so the calls wait for each other.
/// imbalance: how much heavier than the mean a part may be, e.g. 0.3. Returns the part of each vertex.
std::vector<int> partition_graph(const Graph& graph, int k, double imbalance, int seed);

}  // namespace meshpipe
