// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/triangle_count.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lib/core/topology.h"

using namespace meshpipe;

namespace {

/// Two strips of length 100 and width 1 side by side along x, the first one part 0.
//   +--------------------+
//   |       part 1       |
//   +--------------------+
//   |       part 0       |
//   +--------------------+
Mesh strips() {
  return {{{0, 0, 0}, {100, 0, 0}, {0, 1, 0}, {100, 1, 0}, {0, 2, 0}, {100, 2, 0}},
          {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}}};
}

double count(const std::vector<int>& part, double size) {
  const Mesh mesh = strips();
  const std::vector<int> opposite = opposite_halfedges(mesh);
  return count_with_borders({mesh, opposite}, part, std::vector<double>(mesh.points.size(), size));
}

}  // namespace

TEST(TriangleCount, ANarrowPartHasTheTrianglesOfItsBorder) {
  // 50 segments and half of one around each strip
  EXPECT_NEAR(count({0, 0, 1, 1}, 2), 2 * (2 * 50 + 2 * 0.5 - 2), 1e-9);
  EXPECT_NEAR(count({0, 0, 0, 0}, 2), 200 / std::sqrt(3.0), 1e-9)
      << "as the area: nothing is between the strips";
  EXPECT_NEAR(count({0, 0, 1, 1}, 0.01), 200 / (0.25 * std::sqrt(3.0) * 1e-4), 1e-2)
      << "the area asks for more";
}

TEST(TriangleCount, AFaceHasAllItsCorners) {
  const Mesh cube{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                  {{0, 2, 1},
                   {0, 3, 2},
                   {4, 5, 6},
                   {4, 6, 7},
                   {0, 1, 5},
                   {0, 5, 4},
                   {1, 2, 6},
                   {1, 6, 5},
                   {2, 3, 7},
                   {2, 7, 6},
                   {3, 0, 4},
                   {3, 4, 7}}};
  const std::vector<int> opposite = opposite_halfedges(cube), faces{0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};
  EXPECT_NEAR(count_with_borders({cube, opposite}, faces, std::vector<double>(8, 1000)), 12, 1e-9);
}
