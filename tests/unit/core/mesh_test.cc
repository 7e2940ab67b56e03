// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/mesh.h"

#include <gtest/gtest.h>

#include "lib/core/error.h"
#include "lib/core/largest_patch.h"

using namespace meshpipe;

//  3---2      two triangles, one label each
//  | 1/|
//  | / |
//  |/0 |
//  0---1
static Mesh square() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

TEST(Mesh, HalfEdgesOfATriangleCycle) {
  EXPECT_EQ(next(3), 4);
  EXPECT_EQ(next(5), 3);
  EXPECT_EQ(prev(3), 5);
  EXPECT_EQ(origin(square().tris, 4), 2);
  EXPECT_EQ(target(square().tris, 5), 0);
}

TEST(Mesh, SplitByLabelGivesEveryPartItsOwnNumbers) {
  auto parts = split_by_label(square(), {1, 0}, 2);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].face, std::vector<int>{1});
  EXPECT_EQ(parts[0].vertex, (std::vector<int>{0, 2, 3}));
  EXPECT_EQ(parts[1].vertex, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(parts[0].tris[0], (Tri{0, 1, 2}));
  EXPECT_EQ(parts[0].points[2].y, 1);
}

TEST(Mesh, LargestPatchLeavesNumbersForMore) {
  constexpr int most = std::numeric_limits<int>::max();
  EXPECT_EQ(largest_patch({}, 1), 0);
  EXPECT_EQ(largest_patch({-3}, 1), 0);
  EXPECT_EQ(largest_patch({2, 7, 1}, 5), 7);
  EXPECT_EQ(largest_patch({most - 2}, 2), most - 2);
  EXPECT_THROW(largest_patch({most - 2}, 3), NotAdmissible);
}

TEST(Mesh, KappaIsOneForTheEquilateralAndZeroForTheFlat) {
  EXPECT_NEAR(kappa({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}), 1, 1e-15);
  EXPECT_EQ(kappa({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0);
  // right isosceles: 4 s s 1 / (2 s + 1), s = sqrt(1/2)
  EXPECT_NEAR(kappa({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 2 / (std::sqrt(2.0) + 1), 1e-15);
}

TEST(Mesh, AreaAndDiagonalOfTheUnitSquare) {
  EXPECT_DOUBLE_EQ(total_area(square()), 1);
  EXPECT_DOUBLE_EQ(diagonal(square()), std::sqrt(2.0));
}

TEST(Table, ColumnsAreTypedAndNamed) {
  Table t{"face", 0, {}};
  t.set<int>("patch", {1, 2});
  EXPECT_EQ(t.rows, 2u);
  EXPECT_EQ(t.get<int>("patch")[1], 2);
  EXPECT_THROW(t.get<double>("patch"), NotAdmissible);
  EXPECT_THROW(t.get<int>("part"), NotAdmissible);
  EXPECT_THROW(t.set<int>("part", {1}), std::logic_error);
  t.erase("patch");
  EXPECT_FALSE(t.has("patch"));
}
