// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/injective.h"

#include <gtest/gtest.h>

#include "lib/core/topology.h"

using namespace meshpipe;

//  3-------2
//  | \   / |
//  |   4   |
//  | /   \ |
//  0-------1
static const std::vector<Tri> star{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
static std::vector<Vec2> square(Vec2 center) { return {{0, 0}, {1, 0}, {1, 1}, {0, 1}, center}; }

TEST(Injective, CountsInvertedAndFlatTriangles) {
  EXPECT_EQ(count_inverted(star, square({0.2, 0.7})), 0);
  EXPECT_EQ(count_inverted(star, square({1.5, 0.5})), 1);
  EXPECT_EQ(count_inverted(star, square({1, 0.5})), 1);
  EXPECT_EQ(count_inverted(star, square({1, 1})), 2);
}

TEST(Injective, VerticesAreMovedIntoTheKernel) {
  auto uv = square({3, 0.5});
  auto opposite = opposite_halfedges(star, 5);
  EXPECT_EQ(repair_stars({Mesh{{}, star}, opposite}, 3, uv), 0);
  EXPECT_NEAR(uv[4].x, 0.5, 1e-12);
  // no kernel: the border itself is inverted there, and nothing moves
  std::vector<Vec2> crossed{{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.5, 0.5}}, before = crossed;
  EXPECT_GT(repair_stars({Mesh{{}, star}, opposite}, 3, crossed), 0);
  for (int v = 0; v < 5; ++v) EXPECT_EQ(crossed[v], before[v]);
}

// A ring of n quadrilaterals, the inner vertices 0..n-1 at radius r0 and the outer ones n..2n-1 at r1, whose
// angle runs over `turns` rounds; closed.
static std::vector<Tri> ring(int n) {
  std::vector<Tri> tris;
  for (int i = 0; i < n; ++i) {
    int j = (i + 1) % n;
    tris.push_back({i, n + i, n + j});
    tris.push_back({i, n + j, j});
  }
  return tris;
}
static std::vector<Vec2> ring_uv(int n, double r0, double r1, int turns, double sign = 1) {
  std::vector<Vec2> uv;
  for (double r : {r0, r1})
    for (int i = 0; i < n; ++i) {
      double a = 2 * 3.14159265358979 * turns * i / n;
      uv.push_back({r * std::cos(a), sign * r * std::sin(a)});
    }
  return uv;
}

TEST(Injective, BordersOfARing) {
  auto tris = ring(12);
  auto opposite = opposite_halfedges(tris, 24);
  auto simple = [&](const std::vector<Vec2>& uv) { return border_is_simple({Mesh{{}, tris}, opposite}, uv); };
  EXPECT_TRUE(simple(ring_uv(12, 1, 2, 1)));
  EXPECT_TRUE(simple(ring_uv(12, 2, 1, 1, -1)));  // inside out is as good
  EXPECT_FALSE(simple(ring_uv(12, 1, 2, 2)));     // wound twice: every triangle is positive, the borders meet
  EXPECT_EQ(count_inverted(tris, ring_uv(12, 1, 2, 2)), 0);
  EXPECT_FALSE(border_crossings({Mesh{{}, tris}, opposite}, ring_uv(12, 1, 2, 2)).empty());
  auto moved = ring_uv(12, 1, 2, 1);
  for (int i = 0; i < 12; ++i) moved[i].x += 1.7;  // the hole across the rim
  EXPECT_FALSE(simple(moved));
  for (int i = 0; i < 12; ++i) moved[i].x += 10;  // and far outside: then triangles have to be inverted
  EXPECT_GT(count_inverted(tris, moved), 0);
}

TEST(Injective, AFlatHoleIsNotSimple) {
  const auto tris = ring(4);
  const auto opposite = opposite_halfedges(tris, 8);
  for (double height : {1e-3, 1e-16}) {
    const std::vector<Vec2> uv{{0.5, 0}, {0, height}, {-0.5, 0}, {0, -height},
                               {10, 0},  {0, 10},     {-10, 0},  {0, -10}};
    EXPECT_EQ(count_inverted(tris, uv), 0);
    EXPECT_EQ(border_is_simple({Mesh{{}, tris}, opposite}, uv), height == 1e-3);
  }
}

TEST(Injective, TouchingBordersAreNotSimple) {
  auto tris = ring(12);
  auto uv = ring_uv(12, 1, 2, 1);
  uv[0] = uv[12];  // a vertex of the hole on one of the rim
  EXPECT_FALSE(border_is_simple({Mesh{{}, tris}, opposite_halfedges(tris, 24)}, uv));
}
