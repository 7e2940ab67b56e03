// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/surface_walk.h"

#include <gtest/gtest.h>

using namespace meshpipe;

namespace {

//  a strip of n squares along x, two triangles each, folded by 90 degrees at x = 2 (up in z)
//  1---3---5
//  | \ | \ |
//  0---2---4
Mesh strip(int n) {
  Mesh m;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2; ++j)
      m.points.push_back(i <= 2 ? Vec3{1. * i, 1. * j, 0} : Vec3{2, 1. * j, i - 2.});
  for (int i = 0; i < n; ++i) {
    m.tris.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    m.tris.push_back({2 * i + 2, 2 * i + 3, 2 * i + 1});
  }
  return m;
}

TEST(SurfaceWalk, FindsTheNearestPlaceAcrossAFold) {
  Mesh m = strip(4);
  SurfaceWalk walk(m, {});
  Place p = walk.closest({0, 1, 0, 0}, {2.1, 0.5, 1.5});
  Vec3 x = walk.point(p);
  EXPECT_NEAR(x.x, 2, 1e-15);
  EXPECT_NEAR(x.y, 0.5, 1e-15);
  EXPECT_NEAR(x.z, 1.5, 1e-15);
}

TEST(SurfaceWalk, StopsAtTheBorderAndAtWalls) {
  Mesh m = strip(4);
  EXPECT_NEAR(SurfaceWalk(m, {}).closest({0, 1, 0, 0}, {-1, 0.25, 0}).b0, 0.75, 1e-15);
  // the edge from 2 to 3 is a model edge: nothing gets past it
  SurfaceWalk walled(m, {0, 0b001, 0b100, 0, 0, 0, 0, 0});
  Vec3 x = walled.point(walled.closest({0, 1, 0, 0}, {2.1, 0.5, 1.5}));
  EXPECT_NEAR(x.x, 1, 1e-15);
  x = walled.point(walled.closest({0, 1, 0, 0}, {2.1, 0.5, 1.5}, true));
  EXPECT_NEAR(norm(x - Vec3{2, 0.5, 1.5}), 0, 1e-15);
}

// the border from 0 to 4 of the strip, on which rounding has left the places
TEST(SurfaceWalk, SlidesFromPlacesThatRoundingHasLeftNextToALine) {
  const Mesh m = strip(4);
  const SurfaceWalk walk(m, {});
  for (const Place& from : {Place{0, 0.6, 0.4, 1e-17}, Place{0, 1 - 1e-15, 1e-15, 0}})
    EXPECT_NEAR(norm(walk.point(walk.slide(from, {1.5, 0.1, 0})) - Vec3{1.5, 0, 0}), 0, 1e-12);
}

// corners 0 and 1, joined by the border over 2; 3 between them is joined with both and with 4 above by model
// edges
TEST(SurfaceWalk, BetweenTwoCornersItSlidesOnTheLineThatJoinsThem) {
  const Mesh m{{{0, 0, 0}, {4, 0, 0}, {2, -1, 0}, {2, 0.2, 0}, {2, 2, 0}},
               {{0, 2, 3}, {2, 1, 3}, {0, 3, 4}, {3, 1, 4}}};
  const SurfaceWalk walk(m, {0b100, 0b010, 0b011, 0b101});
  const Place corner{0, 1, 0, 0}, other{1, 0, 1, 0};
  EXPECT_EQ(walk.point(walk.slide(corner, {2, 0, 0})), (Vec3{2 * 2 / 2.02, 0.2 / 1.01, 0}));
  const Vec3 x = walk.point(walk.slide(corner, other, {2, 0, 0}));
  EXPECT_NEAR(norm(x - Vec3{1.6, -0.8, 0}), 0, 1e-15);
}

}  // namespace
