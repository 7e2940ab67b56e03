// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/core/connectivity.h"
#include "lib/core/topology.h"
#include "lib/defeature/defeature.h"

using namespace meshpipe;

namespace {

//       3
//     / | \      the cap is 0 1 2: vertex 2 is hardly above the edge 0 1
//   0 --2-- 1
//     \   /
//       4
Surface with_cap(double height) {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0.4, height, 0}, {0.5, 1, 0}, {0.5, -1, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 4}};
  s.face.rows = s.tris.size();
  s.face.set("patch", std::vector<int>{5, 5, 5, 5});
  s.face.set("load", std::vector<double>{1, 2, 3, 4});
  return s;
}

const std::vector<int> no_lines(12, -1);

Flips flip(Surface& s, const std::vector<int>& line, double tolerance) {
  std::vector<int> opposite = opposite_halfedges(s);
  const Flips flips = flip_caps_and_folds({s, opposite}, line, tolerance);
  EXPECT_EQ(opposite, opposite_halfedges(s));
  return flips;
}

}  // namespace

TEST(Caps, AreFlippedWithTheTriangleAcrossTheirLongestEdge) {
  Surface s = with_cap(1e-7);
  EXPECT_EQ(flip(s, no_lines, 0).count, 1);
  for (int t = 0; t < 4; ++t) EXPECT_GT(area_vector(s, t).z, 0.3) << t;
  EXPECT_EQ(boundary_loops(opposite_halfedges(s)).size(), 1u);
  EXPECT_EQ(s.face.get<double>("load"), (std::vector<double>{4, 2, 3, 4}));
  EXPECT_EQ(flip(s, no_lines, 0).count, 0);
}

TEST(Caps, AreFlippedOneAfterTheOtherWhereTheyLeanOnEachOther) {
  Surface s = with_cap(1e-7);
  s.points.push_back({0.7, 2e-7, 0});  // a second one between the first and the triangles above it
  // the upper one comes first, which has nothing below it to be flipped with until the lower one is gone
  s.tris = {{2, 1, 5}, {0, 1, 2}, {0, 2, 3}, {5, 1, 3}, {1, 0, 4}, {2, 5, 3}};
  s.face = {"face", s.tris.size(), {}};
  EXPECT_EQ(flip(s, std::vector<int>(18, -1), 0).count, 2);
  for (int t = 0; t < 6; ++t) EXPECT_GT(area_vector(s, t).z, 0.2) << t;
}

TEST(Caps, StayWhereTheyAreHighOrTheEdgeIsALineOrBetweenPatches) {
  Surface high = with_cap(1e-4), line = with_cap(1e-7), patches = with_cap(1e-7);
  EXPECT_EQ(flip(high, no_lines, 0).count, 0);
  std::vector<int> on_edge = no_lines;
  on_edge[0] = 3;
  EXPECT_EQ(flip(line, on_edge, 0).count, 0);
  patches.face.get<int>("patch")[3] = 6;
  EXPECT_EQ(flip(patches, no_lines, 0).count, 0);
}

TEST(Caps, StayWhereTheyAreOnlySmallAndTheEdgeIsACrease) {
  auto flips = [](double cap, double down) {
    Surface s = with_cap(cap);
    s.points[4] = {0.5, -0.1, down};
    for (Vec3& p : s.points) p = 1e-6 * p;
    s.points.push_back({2, 2, 0});  // the rest of the surface
    s.points.push_back({2, 3, 0});
    s.points.push_back({3, 2, 0});
    s.tris.push_back({5, 7, 6});
    s.face = {"face", s.tris.size(), {}};
    return flip(s, std::vector<int>(15, -1), 0).count;
  };
  EXPECT_EQ(flips(0.1, -1), 0);
  EXPECT_EQ(flips(0.01, -1), 1);
  EXPECT_EQ(flips(0.1, 0), 1);
}

TEST(Caps, StayWhereTheirCornerIsNextToAnEndOfTheEdge) {
  Surface s = with_cap(1e-8);
  s.points[2].x = 1e-4;  // the other diagonal would make a needle of 0, 4 and 2
  EXPECT_EQ(flip(s, no_lines, 0).count, 0);
}

TEST(Caps, StayWhereTheOtherDiagonalIsAnEdgeAlready) {
  //  a thin double triangle: its apexes are joined on the way around
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-7, 0}, {0.5, -1, 0}};
  s.tris = {{0, 1, 2}, {1, 0, 3}, {0, 2, 3}, {2, 1, 3}};
  s.face.rows = s.tris.size();
  EXPECT_EQ(flip(s, no_lines, 0).count, 0);
}

//   3---------2     vertex 4 should be left of the diagonal 0 2 and is a little right of it, so that the
//   |      /  |     triangle 0 2 4 lies on its back
//   |   / 4   |
//   0---------1
TEST(Caps, WhatLiesFlatOnItselfIsUnfolded) {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.52, 0.48, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 4}, {4, 2, 3}, {0, 4, 3}};
  s.face.rows = s.tris.size();
  const Flips flips = flip(s, no_lines, 1e-9);
  EXPECT_EQ(flips.count, 1);
  EXPECT_NEAR(flips.moved, 0, 1e-12);  // others lie where it was
  for (int t = 0; t < 4; ++t) EXPECT_GT(area_vector(s, t).z, 0) << t;
  EXPECT_EQ(boundary_loops(opposite_halfedges(s)).size(), 1u);
}

//   6 ___ 0 ______ 2     the triangle 0 2 4 is folded over the border and lies on the triangle 0 1 2
//    |   / \ \  4  /
//    |  /    \   /
//   5 ---------1
TEST(Caps, AFlapIsNotCutOffIfItIsLarge) {
  Surface s;
  s.points = {{0, 0, 0},         {0.5, -0.8, 0}, {1, 0, 0},   {2, 2, 0},
              {0.5, -0.4, 0.03}, {-1, -0.8, 0},  {-1, 0.3, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 4}, {0, 5, 1}, {0, 6, 5}};
  s.face.rows = s.tris.size();
  EXPECT_EQ(flip(s, no_lines, 0.3).count, 0);
  const Flips flips = flip(s, no_lines, 0.4);
  EXPECT_EQ(flips.count, 1);
  EXPECT_GT(flips.moved, 0.3);  // the middle of 0 2 is as far from the edges 0 4 and 2 4
  EXPECT_LT(flips.moved, 0.4);
}

TEST(Caps, TheSharpRimOfALensStays) {
  Surface s;
  for (int i = 0; i < 8; ++i) s.points.push_back({std::cos(i * 0.785398), std::sin(i * 0.785398), 0});
  s.points.push_back({0, 0, 0.02});
  s.points.push_back({0, 0, -0.02});
  for (int i = 0; i < 8; ++i) {
    s.tris.push_back({i, (i + 1) % 8, 8});
    s.tris.push_back({(i + 1) % 8, i, 9});
  }
  s.face.rows = s.tris.size();
  EXPECT_EQ(flip(s, std::vector<int>(48, -1), 1).count, 0);
}
