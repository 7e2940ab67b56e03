// SPDX-License-Identifier: BSD-3-Clause
// One vertex for all at the same place, to the last bit or within a tolerance.
#pragma once
#include <cstddef>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Numbers points as they come: equal ones (0 and -0 are) alike.
class PointNumbers {
 public:
  /// Room for about this many distinct points; it grows.
  explicit PointNumbers(std::size_t expected);
  /// The numbers of n more points. Best called with many at a time: what memory holds of them is fetched
  /// ahead.
  void add(const Vec3* points, int n, int* numbers);
  /// The distinct points by their number.
  std::vector<Vec3> points;

 private:
  void make_room(std::size_t n);
  std::vector<int> slot_;  ///< a table of numbers, by a hash of their points; -1 is free
};

/// Makes one vertex of all that have the same coordinates, and drops those that no triangle uses; vertices
/// are numbered by first use. Triangles stay as they are otherwise.
void weld(Mesh& mesh);

/// The first vertex with used != 0 and the coordinates of v, for every v (0 and -0 are equal); v itself if it
/// is not used.
std::vector<int> first_equal(const std::vector<Vec3>& points, const std::vector<char>& used);

/// Goes on from `same` as `first_equal` made it: a vertex that lies no farther than `tolerance` > 0 from an
/// earlier one that was kept is merged into the nearest of them. No vertex moves by more than the tolerance,
/// and chains of close vertices do not run together. Returns the number of vertices merged. Linear for
/// tolerances below the edges' length.
int merge_near(const std::vector<Vec3>& points, const std::vector<char>& used, double tolerance,
               std::vector<int>& same);

}  // namespace meshpipe
