// SPDX-License-Identifier: BSD-3-Clause
// Shares of a check: what is measured next to some triangles needs only what is around them.
#pragma once
#include <array>
#include <functional>

#include "lib/check/distance.h"

namespace meshpipe {

/// Triangles of the result and of the reference in one box, and those of both around them.
struct CheckShare {
  Mesh mesh, other;             ///< of the result, of the reference; of each the own triangles come first
  int own = 0, other_own = 0;   ///< their numbers
  std::vector<int> triangles;   ///< rows in the result of the triangles of `mesh`
  std::vector<int> vertices;    ///< rows in the result of its vertices
  std::vector<double> allowed;  ///< distance, per triangle of `mesh`
  double diagonal = 1;          ///< of the reference
  double most = 0;              ///< a distance below it is bounded by it; 0: none
  /// Points to measure the mean with, and to bound the distance, from the reference and from the result.
  std::array<int, 2> samples{1, 1}, budget{0, 0};
};

/// What was measured; rows are those of the result.
struct ShareFindings {
  std::array<double, 2> area{0, 0};                ///< of the own triangles of the reference, of the result
  std::array<OneWay, 2> distance;                  ///< from them, without `deviation.ratio`
  std::vector<std::pair<int, double>> ratios;      ///< triangles with a deviation that is not small
  std::vector<std::pair<int, double>> off;         ///< distances of vertices
  std::vector<std::pair<int, int>> intersections;  ///< pairs of triangles
  std::vector<int> folds;                          ///< half-edges
};

/// Receives a share, its number, and the number of all shares.
using TakeShare = std::function<void(CheckShare, int, int)>;
/// Cuts the check of a result into shares of at most `triangles` of each surface on average, and calls `take`
/// for each. `reference`: as examine compares with. `allowed` (per triangle of the result) and `samples`: as
/// for distance_between; `most`: a length, or 0.
void cut_check(const Mesh& result, const Mesh& reference, const std::vector<double>& allowed, int triangles,
               int samples, double most, const TakeShare& take);

/// Measures the distances, intersections and folds of a share.
ShareFindings measure(const CheckShare& share);

/// Joins what was measured by all shares. Distances over the diagonal of the reference.
struct Measured {
  Distance distance;
  std::vector<double> off;  ///< per vertex
  std::vector<std::pair<int, int>> intersections;
  std::vector<int> folds;
};
/// Joins what was measured in all shares. `diagonal`: of the reference; `allowed`: as for cut_check.
Measured join_findings(const std::vector<ShareFindings>& shares, const Mesh& result, double diagonal,
                       std::vector<double> allowed);

}  // namespace meshpipe
