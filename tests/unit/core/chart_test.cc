// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/chart.h"

#include <gtest/gtest.h>

#include <random>

#include "lib/core/error.h"
#include "lib/core/predicates.h"

using namespace meshpipe;

// A strip of an annulus that is not quite closed (a letter C): n cells along, m across, radius 1 to 2, with
// the inner vertices jittered; locating in it needs more than a straight walk.
static Chart letter_c(int n, int m) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  Chart c;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      bool inner = 0 < i && i < n && 0 < j && j < m;
      double a = 5.5 * (i + (inner ? jitter(random) : 0)) / n, r = 1 + (j + (inner ? jitter(random) : 0)) / m;
      c.uv.push_back({r * std::cos(a), r * std::sin(a)});
      c.mesh.points.push_back({c.uv.back().x, c.uv.back().y, 0});
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      int a = i * (m + 1) + j, b = a + m + 1;
      c.mesh.tris.push_back({a, a + 1, b + 1});
      c.mesh.tris.push_back({a, b + 1, b});
    }
  index_chart(c);
  return c;
}

static Vec2 point(const Chart& c, const Place& p) {
  const Tri& t = c.mesh.tris[p.face];
  return p.b0 * c.uv[t[0]] + p.b1 * c.uv[t[1]] + p.b2 * c.uv[t[2]];
}

TEST(Chart, LocatesFromAnyHintInsideAndOutside) {
  Chart chart = letter_c(60, 6), bare = chart;
  bare.grid = {};  // the scan is the reference
  for (const Tri& t : chart.mesh.tris) ASSERT_GT(orient2d(chart.uv[t[0]], chart.uv[t[1]], chart.uv[t[2]]), 0);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-3, 3);
  int inside = 0;
  for (int k = 0; k < 3000; ++k) {
    Vec2 p{coordinate(random), coordinate(random)};
    Place a = locate(chart, p, (int)(random() % chart.mesh.tris.size())), b = locate(bare, p, -1);
    for (double x : {a.b0, a.b1, a.b2}) ASSERT_TRUE(x >= 0 && x <= 1);
    double da = norm(point(chart, a) - p), db = norm(point(chart, b) - p);
    ASSERT_NEAR(da, db, 1e-12) << p.x << ' ' << p.y;
    inside += db < 1e-12;
  }
  EXPECT_GT(inside, 400);
  EXPECT_LT(inside, 1200);
}

TEST(Chart, VerticesAreLocatedExactly) {
  Chart chart = letter_c(20, 3);
  for (Vec2 p : chart.uv) EXPECT_LT(norm(point(chart, locate(chart, p, 7)) - p), 1e-15);
}

//  3---2
//  | / |   a square in two parts; the diagonal is in both
//  0---1
static Surface square_in_two() {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 3}};
  s.face.set<int>("part", {1, 0});
  return s;
}

static Table rows(std::vector<std::pair<int, int>> part_vertex) {
  Surface s = square_in_two();
  std::vector<int> part, vertex;
  std::vector<double> u, v;
  for (auto [p, i] : part_vertex) {
    part.push_back(p);
    vertex.push_back(i);
    u.push_back(i < 4 ? s.points[i].x + 10 * p : 0);
    v.push_back(i < 4 ? s.points[i].y : 0);
  }
  Table t{"chart_vertex", 0, {}};
  t.set("part", part);
  t.set("vertex", vertex);
  t.set("u", u);
  t.set("v", v);
  return t;
}

TEST(Chart, MadeFromRowsInAnyOrder) {
  auto charts = make_charts(square_in_two(), rows({{1, 2}, {0, 3}, {1, 0}, {0, 0}, {1, 1}, {0, 2}}), 2);
  ASSERT_EQ(charts.size(), 2u);
  EXPECT_EQ(charts[0].mesh.vertex, (std::vector<int>{0, 2, 3}));
  EXPECT_EQ(charts[0].uv[2], (Vec2{0, 1}));
  EXPECT_EQ(charts[1].uv[2], (Vec2{11, 1}));
  EXPECT_EQ(locate(charts[1], {10.9, 0.5}, 0).face, 0);
}

TEST(Chart, WrongRowsAreNamed) {
  EXPECT_THROW(make_charts(square_in_two(), rows({{1, 2}, {0, 3}, {1, 0}, {0, 0}, {1, 1}}), 2), BadInput);
  EXPECT_THROW(make_charts(square_in_two(), rows({{1, 2}, {0, 3}, {1, 0}, {0, 0}, {1, 1}, {0, 1}}), 2),
               BadInput);
  EXPECT_THROW(make_charts(square_in_two(), rows({{1, 2}, {0, 3}, {1, 0}, {0, 0}, {1, 1}, {1, 1}}), 2),
               BadInput);
  EXPECT_THROW(make_charts(square_in_two(), rows({{1, 2}, {0, 3}, {2, 0}, {0, 0}, {1, 1}, {0, 2}}), 2),
               BadInput);
  EXPECT_THROW(make_charts(square_in_two(), rows({{1, 2}, {0, 3}, {1, 7}, {0, 0}, {1, 1}, {0, 2}}), 2),
               BadInput);
  Table mirrored = rows({{1, 2}, {0, 3}, {1, 0}, {0, 0}, {1, 1}, {0, 2}});
  for (double& x : mirrored.get<double>("u")) x = -x;
  EXPECT_THROW(make_charts(square_in_two(), mirrored, 2), BadInput);
}
