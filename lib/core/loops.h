// SPDX-License-Identifier: BSD-3-Clause
// Lengths of loops of half-edges.
#pragma once
#include "lib/core/connectivity.h"

namespace meshpipe {

inline double loop_length(const Mesh& mesh, const std::vector<int>& loop) {
  double length = 0;
  for (int h : loop) length += edge_length(mesh, h);
  return length;
}

/// Returns the number of the longest loop, the first of equals. Requires: there is one.
inline std::size_t longest_loop(const Mesh& mesh, const std::vector<std::vector<int>>& loops) {
  std::size_t longest = 0;
  double most = loop_length(mesh, loops[0]);
  for (std::size_t l = 1; l < loops.size(); ++l)
    if (const double length = loop_length(mesh, loops[l]); length > most) most = length, longest = l;
  return longest;
}

}  // namespace meshpipe
