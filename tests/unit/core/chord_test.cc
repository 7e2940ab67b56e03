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

}  // namespace
