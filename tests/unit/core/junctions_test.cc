// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/junctions.h"

#include <gtest/gtest.h>

#include "lib/core/topology.h"

using namespace meshpipe;

/// Three triangles on the edge from the origin to x = 1, each with its own copies of its ends.
static Surface three_sheets() {
  Surface s;
  for (Vec3 apex : {Vec3{0.5, 1, 0}, Vec3{0.5, -1, 0}, Vec3{0.5, 0, 1}}) {
    const int n = (int)s.points.size();
    for (Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, apex}) s.points.push_back(p);
    s.tris.push_back({n, n + 1, n + 2});
  }
  s.vertex.rows = s.points.size();
  s.vertex.set<double>("size", {0, 1, 2, 0, 1, 2, 0, 1, 2});
  s.face.set<int>("part", {0, 1, 2});
  return s;
}

TEST(Junctions, BordersAtTheSamePlaceAreJoined) {
  Surface s = three_sheets();
  Mesh joined = s;
  EXPECT_EQ(join_borders(joined), (std::vector<int>{0, 1, 2, 5, 8}));
  EXPECT_EQ(joined.points.size(), 5u);
  EXPECT_EQ(joined.tris[2], (Tri{0, 1, 4}));
}

TEST(Junctions, SheetsMayMeetInTheirBordersOnly) {
  Mesh three = three_sheets();
  EXPECT_TRUE(sheet_intersections(three, Bvh(three)).empty());
  EXPECT_EQ(three.points.size(), 5u);
  // a fourth one goes on across the edge
  Mesh four = three_sheets();
  const int n = (int)four.points.size();
  for (Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.5, 1, 1}, Vec3{0.5, 1, -1}}) four.points.push_back(p);
  four.tris.push_back({n, n + 1, n + 2});
  four.tris.push_back({n + 1, n, n + 3});
  EXPECT_EQ(sheet_intersections(four, Bvh(four)), (std::vector<std::pair<int, int>>{{0, 3}, {0, 4}}));
}

TEST(Junctions, BordersAreCutAtTheSamePoints) {
  Surface s = three_sheets();
  Table chart{"chart_vertex", 0, {}};
  chart.set<int>("part", {0, 0, 0, 1, 1, 1, 2, 2, 2});
  chart.set<int>("vertex", {0, 1, 2, 3, 4, 5, 6, 7, 8});
  chart.set<double>("u", {0, 4, 2, 0, 4, 2, 0, 4, 2});
  chart.set<double>("v", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  // the first sheet is cut at a quarter, the second at a half
  for (auto [t, x] : {std::pair{0, 0.25}, {1, 0.5}}) {
    const int v = (int)s.points.size();
    const Tri old = s.tris[t];
    s.points.push_back({x, 0, 0});
    s.tris[t][1] = v;
    s.tris.push_back({v, old[1], old[2]});
    s.vertex.get<double>("size").push_back(x);
    s.face.get<int>("part").push_back(t);
    chart.get<int>("part").push_back(t);
    chart.get<int>("vertex").push_back(v);
    chart.get<double>("u").push_back(4 * x);
    chart.get<double>("v").push_back(0);
  }
  s.vertex.rows = s.points.size();
  s.face.rows = s.tris.size();
  chart.rows = 11;
  EXPECT_EQ(match_borders(s, &chart), 4);
  EXPECT_EQ(match_borders(s, &chart), 0);
  EXPECT_EQ(s.tris.size(), 9u);
  EXPECT_EQ(chart.rows, 15u);
  Mesh joined = s;
  join_borders(joined);
  EXPECT_EQ(joined.points.size(), 7u);
  for (std::size_t i = 0; i < chart.rows; ++i) {
    const int v = chart.get<int>("vertex")[i];
    EXPECT_NEAR(chart.get<double>("u")[i], 4 * s.points[v].x, 1e-15);
    if (s.points[v].x > 0.2 && s.points[v].x < 0.6 && s.points[v].y == 0 && s.points[v].z == 0) {
      EXPECT_NEAR(s.vertex.get<double>("size")[v], s.points[v].x, 1e-15);
    }
  }
}

TEST(Junctions, AnEdgeIsCutWhereTwoOthersAlreadyAre) {
  Surface s = three_sheets();
  for (int t : {0, 1}) {
    const Tri old = s.tris[t];
    const int v = (int)s.points.size();
    s.points.push_back({0.5, 0, 0});
    s.tris[t][1] = v;
    s.tris.push_back({v, old[1], old[2]});
    s.vertex.get<double>("size").push_back(0.5);
    s.face.get<int>("part").push_back(t);
  }
  s.vertex.rows = s.points.size();
  s.face.rows = s.tris.size();
  EXPECT_EQ(match_borders(s, nullptr), 1);
  EXPECT_EQ(s.tris.size(), 6u);
}
