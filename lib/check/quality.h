// SPDX-License-Identifier: BSD-3-Clause
// Shapes of triangles and lengths of edges.
#pragma once
#include <span>
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

struct Quality {
  double kappa_min = 0, kappa_p01 = 0, kappa_mean = 0;
  int worst = -1;                                           ///< the triangle with kappa_min
  double min_angle = 0, mean_min_angle = 0, max_angle = 0;  ///< degrees
  /// Edge lengths in units of the size field (its mean over the edge), or of the mean edge.
  double edge_min = 0, edge_mean = 0, edge_max = 0, edge_deviation = 0;
  double valence567 = 0;             ///< share of the inner vertices with 5, 6 or 7 neighbors
  std::vector<int> angle_histogram;  ///< smallest angles, 60 bins over [0, 60] degrees
  std::vector<float> kappas;         ///< of every triangle
};

/// Measures the shapes of triangles and lengths of edges. `size`: per vertex, or empty.
Quality quality_of(const Connectivity& surface, const std::vector<double>& size);

/// Counts the values in each of n equal intervals of [low, high]; values outside are left out.
std::vector<int> bins(std::span<const float> values, double low, double high, int n);

}  // namespace meshpipe
