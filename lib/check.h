// SPDX-License-Identifier: BSD-3-Clause
// The verdict on a result: topology, orientation, intersections, quality, distance to the reference.
#pragma once
#include "lib/mesh.h"
#include "lib/topology.h"

namespace meshpipe {

struct Quality {
  double kappa_min = 0, kappa_p01 = 0, kappa_mean = 0;
  double min_angle = 0, mean_min_angle = 0, max_angle = 0;  ///< degrees
  double edge_min = 0, edge_mean = 0, edge_max = 0, edge_deviation = 0;  ///< in units of the size field, or of the mean edge
  double valence567 = 0;      ///< share of the inner vertices with 5, 6 or 7 neighbours
  std::vector<int> kappa_histogram;  ///< 50 bins over [0, 1]
};
/// `size` per vertex, or empty.
Quality quality_of(const Mesh& mesh, const std::vector<double>& size);

/// Distances of samples over the reference's diagonal; `bound` adds the largest distance between a sample and the points
/// it stands for, so that the true Hausdorff distance is at most hausdorff + bound.
struct Distance {
  double hausdorff = 0, mean = 0, rms = 0, bound = 0;
  double boundary = 0;  ///< Hausdorff distance of the border curves
};
/// Two-sided: the worse of both directions. Deterministic at any thread count. samples: about this many points a side.
Distance distance_between(const Mesh& reference, const Mesh& mesh, int samples = 200000);

}  // namespace meshpipe
