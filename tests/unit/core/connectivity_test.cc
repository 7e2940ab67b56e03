// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/connectivity.h"

#include <gtest/gtest.h>

#include "lib/core/normals.h"
#include "lib/core/topology.h"

using namespace meshpipe;

namespace {

//  3--2   a square of two triangles, 0 1 2 and 0 2 3
//  | /|
//  0--1
struct Square : testing::Test {
  Mesh mesh{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  std::vector<int> opposite = opposite_halfedges(mesh.tris, 4);
  std::vector<std::uint8_t> model{4, 0};  // edge 2-0, from one side
};

// n triangles around vertex 0, closed or open
Mesh wheel(int n, bool closed) {
  Mesh m;
  m.points.push_back({0, 0, 0});
  for (int i = 0; i < (closed ? n : n + 1); ++i) m.points.push_back({std::cos(i), std::sin(i), 0});
  for (int i = 0; i < n; ++i) m.tris.push_back({0, 1 + i, closed && i == n - 1 ? 1 : 2 + i});
  return m;
}

std::vector<int> neighbors(const Mesh& m, int h) {
  std::vector<int> found;
  for_each_neighbor(m.tris, opposite_halfedges(m.tris, (int)m.points.size()), h,
                    [&](int v) { found.push_back(v); });
  return found;
}

}  // namespace

TEST_F(Square, IsSeenThroughTheView) {
  const Connectivity c{mesh, opposite, model};
  EXPECT_EQ(c.n_tris(), 2);
  EXPECT_EQ(c.n_half_edges(), 6);
  EXPECT_EQ(c.n_vertices(), 4);
  EXPECT_EQ(c.from(2), 2);
  EXPECT_EQ(c.to(2), 0);
  EXPECT_EQ(c.apex(2), 1);
  EXPECT_EQ(c.opposite[2], 3);
  EXPECT_TRUE(c.is_border(0));
  EXPECT_FALSE(c.is_border(2));
  EXPECT_TRUE(c.is_model(2));
  EXPECT_FALSE(c.is_model(3));
  EXPECT_FALSE((Connectivity{mesh, opposite}.is_model(2)));
  EXPECT_DOUBLE_EQ(c.length(0), 2);
  EXPECT_EQ(c.area_vector(1), (Vec3{0, 0, 2}));
  EXPECT_DOUBLE_EQ(triangle_area(mesh, 0), 1);
}

TEST_F(Square, PartsHaveBordersTowardsTheRest) {
  const ConnectedPart p = select_part({mesh, opposite, model}, {0, 1}, 0);
  EXPECT_EQ(p.tris, (std::vector<Tri>{{0, 1, 2}}));
  EXPECT_EQ(p.face, std::vector<int>{0});
  EXPECT_EQ(p.opposite, (std::vector<int>{-1, -1, -1}));
  EXPECT_EQ(p.model, std::vector<std::uint8_t>{4});
  const ConnectedPart all = select_part({mesh, opposite}, {7, 7}, 7);
  EXPECT_EQ(all.opposite, opposite);
  EXPECT_TRUE(all.model.empty());
  EXPECT_TRUE(select_part({mesh, opposite}, {0, 1}, 2).tris.empty());
}

TEST_F(Square, NormalsAreWeightedByArea) {
  mesh.points[3] = {0, 0, 1};
  const std::vector<Vec3> face = face_normals(mesh), vertex = vertex_normals(mesh);
  EXPECT_EQ(face[0], (Vec3{0, 0, 1}));
  EXPECT_EQ(vertex[1], face[0]);
  EXPECT_EQ(vertex[3], face[1]);
  EXPECT_EQ(vertex[0], normalized(area_vector(mesh, 0) + area_vector(mesh, 1)));
}

TEST(Fan, ClosedIsVisitedOnceCounterclockwise) {
  EXPECT_EQ(neighbors(wheel(5, true), 3), (std::vector<int>{2, 3, 4, 5, 1}));
}

TEST(Fan, OpenGoesOnToTheOtherSide) {
  EXPECT_EQ(neighbors(wheel(4, false), 6), (std::vector<int>{3, 4, 5, 2, 1}));
}

TEST(Fan, StopsOnRequest) {
  const Mesh m = wheel(6, true);
  const std::vector<int> opposite = opposite_halfedges(m.tris, 7);
  int seen = 0;
  EXPECT_FALSE(for_each_spoke(opposite, 0, [&](int) { return ++seen < 4; }));
  EXPECT_EQ(seen, 4);
  EXPECT_TRUE(for_each_spoke(opposite, 0, [&](int) { ++seen; }));
  EXPECT_EQ(seen, 10);
}

TEST(Fan, BorderOfARegionIsFollowed) {
  const Mesh m = wheel(4, true);
  const std::vector<int> opposite = opposite_halfedges(m.tris, 5);
  auto inside = [](int t) { return t < 2; };
  std::vector<int> loop{1};  // 1-2 of triangle 0
  for (int h = next_on_border(opposite, 1, inside); h != 1; h = next_on_border(opposite, h, inside))
    loop.push_back(h);
  EXPECT_EQ(loop, (std::vector<int>{1, 4, 5, 0}));
}
