// SPDX-License-Identifier: BSD-3-Clause
// Shares of a check: what is measured next to some triangles needs only what is around them.
#pragma once
#include <functional>

#include "lib/check/distance.h"

namespace meshpipe {

/// Some triangles of one surface, and the other surface around them.
struct CheckShare {
  bool of_result = false;  ///< are they of the result, or of the reference?
  int own = 0;             ///< the first triangles of `mesh`; of the result, those next to them follow
  Mesh mesh, other;
  std::vector<int> triangles;   ///< rows in the result of its triangles: those of `mesh`, else of `other`
  std::vector<int> vertices;    ///< rows in the result of the vertices of `mesh`, if it is of the result
  std::vector<double> allowed;  ///< distance, per triangle of the result
  double diagonal = 1;          ///< of the reference
  double most = 0;              ///< a distance below it is bounded by it; 0: none
  int samples = 1, budget = 0;  ///< points to measure the mean with, and to bound the distance
};

/// What was measured; rows are those of the result.
struct ShareFindings {
  bool of_result = false;
  double area = 0;                             ///< of the share's own triangles
  OneWay distance;                             ///< without `deviation.ratio`
  std::vector<std::pair<int, double>> ratios;  ///< triangles with a deviation that is not small
  std::vector<std::pair<int, double>> off;     ///< distances of vertices
  std::vector<std::pair<int, int>> crossings;  ///< pairs of triangles that intersect
  std::vector<int> folds;                      ///< half-edges
};

/// Takes a share, its number, and that of all.
using TakeShare = std::function<void(CheckShare, int, int)>;
/// Cuts the check of a result into shares of at most `triangles`, and calls `take` for each. `reference`: as
/// examine compares with. `allowed` and `samples`: as for distance_between; `most`: a length, or 0.
void cut_check(const Mesh& result, const Mesh& reference, const std::vector<double>& allowed, int triangles,
               int samples, double most, const TakeShare& take);

ShareFindings measure(const CheckShare& share);

/// Joins what was measured by all shares. Distances over the diagonal of the reference.
struct Measured {
  Distance distance;
  std::vector<double> off;  ///< per vertex
  std::vector<std::pair<int, int>> intersections;
  std::vector<int> folds;
};
Measured join_findings(const std::vector<ShareFindings>& shares, const Mesh& result, double diagonal,
                       std::vector<double> allowed);

}  // namespace meshpipe
