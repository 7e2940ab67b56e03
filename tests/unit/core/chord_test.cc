// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/chord.h"

#include <gtest/gtest.h>

using namespace meshpipe;

namespace {

const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0};

TEST(Chord, LeavesAlongATriangleOnlyBetweenItsSidesAndNearItsPlane) {
  EXPECT_TRUE(leaves_along(o, {2, 1, 0}, x, y, 1e-6));
  EXPECT_TRUE(leaves_along(o, {2, 1, 1e-9}, x, y, 1e-6));
  EXPECT_TRUE(leaves_along(o, {2, 0, 0}, x, y, 1e-6));  // along a side
  EXPECT_FALSE(leaves_along(o, {2, 1, 1e-3}, x, y, 1e-6));
  EXPECT_FALSE(leaves_along(o, {2, -1, 0}, x, y, 1e-6));
  EXPECT_FALSE(leaves_along(o, {-1, -1, 0}, x, y, 1e-6));
}

TEST(Chord, ATriangleWithoutAreaHasNoPlane) { EXPECT_FALSE(leaves_along(o, {2, 0, 0}, x, {3, 0, 0}, 1e-6)); }

//     y
//    /|\      o x y lies in the plane z = 0, and across the model edge o y the surface turns back below it;
//    its
//   / | 3     edge from o to 3 runs along o x y, or is lower. 4 is far below.
//  x--o-4
TEST(Chord, PairsAreTheChordAndTheTriangleAlongIt) {
  for (const double z : {-1e-9, -0.1}) {
    const std::vector<Vec3> points{o, x, y, {0.5, 0.4, z}, {0.5, -1, -1}};
    const std::vector<Tri> tris{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    const int opposite[] = {-1, -1, 3, 2, -1, 6, 5, -1, -1};
    auto hard = [&](int h) { return h == 2 || h == 3 || opposite[h] < 0; };
    const auto pairs = chord_pairs(
        tris, points, [&](int h) { return opposite[h]; }, hard);
    ASSERT_EQ(pairs.empty(), z < -1e-6);
    if (!pairs.empty()) {
      EXPECT_EQ(pairs[0].first, 0);
    }
  }
}

}  // namespace
