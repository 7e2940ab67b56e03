// SPDX-License-Identifier: BSD-3-Clause
// One vertex for all at the same place, to the last bit or within a tolerance.
#pragma once
#include <cstddef>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Numbers points in the order in which they come; equal points (0 and -0 are equal) get the same number.
class PointNumbers {
 public:
  /// Reserves memory for about this many distinct points; it grows as needed.
  explicit PointNumbers(std::size_t expected);
  /// Sets the numbers of n more points. Best called with many at a time: memory is fetched ahead.
  void add(const Vec3* points, int n, int* numbers);
  /// The distinct points by their number.
  std::vector<Vec3> points;

 private:
  void make_room(std::size_t n);
  std::vector<int> slot_;  ///< a table of numbers, by a hash of their points; -1 is free
};

/// Merges vertices with the same coordinates and drops those that no triangle uses; vertices are numbered by
/// first use, triangles keep their order and corners.
void weld(Mesh& mesh);

/// Returns for every vertex v the first vertex with used[] != 0 and the same coordinates (0 and -0 are
/// equal); v itself if it is not used.
std::vector<int> first_equal(const std::vector<Vec3>& points, const std::vector<char>& used);

/// Continues from `same`, the result of first_equal: a vertex no farther than `tolerance` (> 0, a length)
/// from an earlier one that was kept is merged into the nearest of those, in `same`. No vertex moves farther,
/// and chains of close vertices do not collapse. Returns the number merged. Linear for tolerances below
/// edges.
int merge_near(const std::vector<Vec3>& points, const std::vector<char>& used, double tolerance,
               std::vector<int>& same);

}  // namespace meshpipe
