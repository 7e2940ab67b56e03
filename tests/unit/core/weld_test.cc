// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/weld.h"

#include <gtest/gtest.h>

#include "lib/core/random.h"

namespace meshpipe {
namespace {

TEST(weld, numbers_points_as_they_come) {
  PointNumbers numbers(0);  // which grows
  Random random(1);
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i)
    points.push_back({(double)random.below(10), (double)random.below(10), random.below(2) ? 0.0 : -0.0});
  std::vector<int> number(points.size());
  numbers.add(points.data(), 1, number.data());
  numbers.add(points.data() + 1, (int)points.size() - 1, number.data() + 1);
  EXPECT_EQ(numbers.points.size(), 100u);
  int next = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(numbers.points[number[i]] == points[i]);
    EXPECT_LE(number[i], next);
    next = std::max(next, number[i] + 1);
  }
}

TEST(weld, first_equal_leaves_out_what_is_not_used) {
  const std::vector<Vec3> points = {{1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(first_equal(points, {0, 1, 1, 1, 1}), (std::vector<int>{0, 1, 2, 1, 2}));
}

//  2---3     two triangles on their own, and a vertex nobody uses
//  | \ |
//  |  \|
//  0---1
TEST(weld, drops_vertices_that_no_triangle_uses) {
  Mesh m{{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}},
         {{1, 2, 3}, {4, 5, 6}}};
  weld(m);
  EXPECT_EQ(m.points.size(), 4u);
  EXPECT_EQ(m.tris, (std::vector<Tri>{{0, 1, 2}, {2, 1, 3}}));
}

}  // namespace
}  // namespace meshpipe
