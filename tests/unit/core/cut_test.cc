// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>

#include "tests/unit/squares.h"

using namespace meshpipe;

namespace {

//  3---2      two triangles; the level is drawn through them by the field
//  | 1/|
//  | / |
//  |/0 |
//  0---1
Surface square_surface() {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 3}};
  return s;
}

// n x n squares of two triangles over the unit square, lifted to a wavy surface
Surface wavy_squares(int n) {
  Surface s;
  static_cast<Mesh&>(s) = unit_squares(n);
  for (Vec3& p : s.points) {
    const double x = p.x / n, y = p.y / n;
    p = {x, y, 0.1 * std::sin(7 * x + 3 * y)};
  }
  return s;
}

using Edge = std::pair<int, int>;

std::map<Edge, std::vector<int>> triangles_of_edges(const Mesh& m) {
  std::map<Edge, std::vector<int>> r;
  for (int h = 0; h < (int)(3 * m.tris.size()); ++h) {
    int a = origin(m.tris, h), b = target(m.tris, h);
    r[{std::min(a, b), std::max(a, b)}].push_back(h / 3);
  }
  return r;
}

// every directed edge once: with the same border edges as before, no T-junction and no fold
void expect_oriented_manifold(const Mesh& m) {
  std::map<Edge, int> directed;
  for (int h = 0; h < (int)(3 * m.tris.size()); ++h) ++directed[{origin(m.tris, h), target(m.tris, h)}];
  for (auto [e, n] : directed) EXPECT_EQ(n, 1) << e.first << "-" << e.second;
}

int euler(const Mesh& m) {
  return (int)m.points.size() - (int)triangles_of_edges(m).size() + (int)m.tris.size();
}

// how many times the triangles with this side form a fan around the vertex they touch most often so
int most_fans(const Mesh& m, const std::vector<int>& side, int which) {
  std::map<int, std::vector<Edge>> links;
  for (std::size_t t = 0; t < m.tris.size(); ++t)
    if (side[t] == which)
      for (int i = 0; i < 3; ++i)
        links[m.tris[t][i]].push_back({m.tris[t][(i + 1) % 3], m.tris[t][(i + 2) % 3]});
  int most = 0;
  for (auto& [v, edges] : links) {
    std::map<int, int> degree;
    for (auto [a, b] : edges) ++degree[a], ++degree[b];
    int ends = 0;
    for (auto [w, d] : degree) ends += d == 1;
    most = std::max(most, std::max(1, ends / 2));
  }
  return most;
}

double smallest_angle(const Mesh& m) {
  double r = 10;
  for (const Tri& t : m.tris)
    for (int i = 0; i < 3; ++i) {
      Vec3 a = m.points[t[i]], b = m.points[t[(i + 1) % 3]], c = m.points[t[(i + 2) % 3]];
      r = std::min(r, angle(b - a, c - a));
    }
  return r;
}

}  // namespace

//  3---2     the level x = 0.5 meets the edges 0-1, 0-2 and 2-3 at 4, 5, 6
//  | :/|
//  | / |
//  |/: |
//  0---1
TEST(Cut, SplitsATriangleWithTwoCrossedEdgesIntoThree) {
  Surface s = square_surface();
  std::vector<int> side;
  EXPECT_EQ(cut_by_scalar_field(s, {-0.5, 0.5, 0.5, -0.5}, {}, side), 3);
  EXPECT_EQ(s.points.size(), 7u);
  EXPECT_EQ(s.tris.size(), 6u);
  ASSERT_EQ(side.size(), 6u);
  EXPECT_EQ(std::count(side.begin(), side.end(), 0), 3);
  for (std::size_t t = 0; t < 6; ++t)
    for (int v : s.tris[t]) EXPECT_TRUE(side[t] ? s.points[v].x >= 0.5 : s.points[v].x <= 0.5);
  expect_oriented_manifold(s);
  EXPECT_EQ(euler(s), 1);
  EXPECT_NEAR(total_area(s), 1, 1e-15);
}

//  3---2     a level through 0, which is on it, cuts one triangle in two
//  | 1/|
//  | / |.
//  |/0.|
//  0---1
TEST(Cut, ALevelThroughACornerSplitsInTwo) {
  Surface s = square_surface();
  std::vector<int> side;
  EXPECT_EQ(cut_by_scalar_field(s, {0, -1, 1, 1}, {}, side), 1);
  EXPECT_EQ(s.tris[0], (Tri{1, 4, 0}));
  EXPECT_EQ(s.tris[1], (Tri{0, 2, 3}));
  EXPECT_EQ(s.tris[2], (Tri{4, 2, 0}));
  EXPECT_EQ(side, (std::vector<int>{0, 1, 1}));
}

TEST(Cut, ALevelAlongAnEdgeOrNowhereCutsNothing) {
  Surface s = square_surface();
  std::vector<int> side;
  EXPECT_EQ(cut_by_scalar_field(s, {0, -1, 0, 1}, {}, side), 0);
  EXPECT_EQ(side, (std::vector<int>{0, 1}));
  EXPECT_EQ(cut_by_scalar_field(s, {1, 2, 3, 4}, {}, side), 0);
  EXPECT_EQ(side, (std::vector<int>{1, 1}));
  EXPECT_EQ(cut_by_scalar_field(s, {-1, -2, -3, -4}, {}, side), 0);
  EXPECT_EQ(side, (std::vector<int>{0, 0}));
  EXPECT_EQ(cut_by_scalar_field(s, {0, 0, 0, 0}, {}, side), 0);
  EXPECT_EQ(side, (std::vector<int>{1, 1}));  // field >= 0
  EXPECT_EQ(s.tris, square_surface().tris);
}

TEST(Cut, ACrossingCloseToAVertexIsMovedToIt) {
  Surface s = square_surface();
  std::vector<int> side;
  // the level passes 0 at 5 % of the edges 0-1 and 0-2, and 1 and 2 are on the same side
  EXPECT_EQ(cut_by_scalar_field(s, {-0.05, 0.95, 0.95, -1}, {}, side, 0.1), 1);
  EXPECT_EQ(side, (std::vector<int>{1, 1, 0}));
  // with less snap it stays where it is
  s = square_surface();
  EXPECT_EQ(cut_by_scalar_field(s, {-0.05, 0.95, 0.95, -1}, {}, side, 0.01), 3);
  EXPECT_NEAR(s.points[4].x, 0.05, 1e-15);
}

//     3        two levels close to 0 on both sides of it: with 0 on the level, the strip
//    /|\       between them would be pinched there, so the crossings stay off 0 by the snap
//   4-0-2
//    \|/
//     1
TEST(Cut, DoesNotPinchTheInterface) {
  Surface s;
  s.points = {{0, 0, 0}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  std::vector<int> side;
  EXPECT_EQ(cut_by_scalar_field(s, {-0.01, -1, 1, -1, 1}, {}, side, 0.1), 6);
  EXPECT_EQ(most_fans(s, side, 0), 1);
  EXPECT_EQ(most_fans(s, side, 1), 1);
  EXPECT_NEAR(s.points[5].x, 0.1, 1e-15);
}

TEST(Cut, NeverPutsAWholeTriangleOnTheLevel) {
  Surface s = square_surface();
  std::vector<int> side;
  // all of triangle 0 is close to the level, seen from 3
  cut_by_scalar_field(s, {-0.01, -0.01, 0.011, 1}, {}, side, 0.4);
  expect_oriented_manifold(s);
  EXPECT_GT(smallest_angle(s), 0.1);
  EXPECT_GT(std::count(side.begin(), side.end(), 0), 0);
}

//  the inactive triangle 1 is split along with the edge 0-2 that it shares, and has no side
TEST(Cut, SplitsInactiveNeighborsConformingly) {
  Surface s = square_surface();
  std::vector<int> side;
  EXPECT_EQ(cut_by_scalar_field(s, {-0.5, 0.5, 0.5, -0.5}, {1, 0}, side), 2);
  expect_oriented_manifold(s);
  EXPECT_EQ(s.tris.size(), 5u);
  EXPECT_EQ(std::count(side.begin(), side.end(), -1), 2);
  EXPECT_EQ(euler(s), 1);
}

TEST(Cut, InterpolatesVertexColumnsAndCopiesFaceColumns) {
  Surface s = square_surface();
  s.vertex.set<double>("size", {1, 2, 3, 4});
  s.vertex.set<int>("kind", {7, 7, 9, 9});
  s.face.set<int>("patch", {5, 6});
  s.face.set<int>("origin", {40, 30});
  std::vector<int> side;
  ASSERT_EQ(cut_by_scalar_field(s, {-0.25, 0.75, 0.75, -0.25}, {}, side), 3);
  EXPECT_EQ(s.vertex.rows, 7u);
  EXPECT_EQ(s.face.rows, 6u);
  const auto& size = s.vertex.get<double>("size");
  ASSERT_EQ(size.size(), 7u);
  EXPECT_NEAR(size[4], 1.25, 1e-15);  // on 0-1
  EXPECT_NEAR(size[5], 1.5, 1e-15);   // on 0-2
  EXPECT_EQ(s.vertex.get<int>("kind")[5], 7);
  for (std::size_t t = 0; t < 6; ++t) {
    int o = s.face.get<int>("origin")[t];
    EXPECT_EQ(s.face.get<int>("patch")[t], o == 40 ? 5 : 6);
    Vec3 center = (1.0 / 3) * (s.points[s.tris[t][0]] + s.points[s.tris[t][1]] + s.points[s.tris[t][2]]);
    EXPECT_EQ(o, center.y < center.x ? 40 : 30);
  }
}

TEST(Cut, AddsTheOriginWhenItIsMissing) {
  Surface s = square_surface();
  std::vector<int> side;
  cut_by_scalar_field(s, {-0.5, 0.5, 0.5, -0.5}, {}, side);
  EXPECT_EQ(s.face.get<int>("origin"), (std::vector<int>{0, 1, 0, 0, 1, 1}));
}

TEST(Cut, ModelBitsFollowTheirEdges) {
  // model edges: the diagonal x = y, and the square's lower side
  for (std::vector<double> field : {std::vector<double>{-0.5, 0.5, 0.5, -0.5},
                                    {-0.5, -0.5, 0.5, 0.5},
                                    {0, -1, 1, 0},
                                    {-1, 1, 0, -1},
                                    {1, -2, 3, -4}}) {
    Surface s = square_surface();
    s.face.set<std::uint8_t>("model", {0b101, 0b001});
    std::vector<int> side;
    cut_by_scalar_field(s, field, {}, side, 0.01);
    const auto& model = s.face.get<std::uint8_t>("model");
    ASSERT_EQ(model.size(), s.tris.size());
    for (int h = 0; h < (int)(3 * s.tris.size()); ++h) {
      Vec3 a = s.points[origin(s.tris, h)], b = s.points[target(s.tris, h)];
      bool expected = (a.x == a.y && b.x == b.y) || (a.y == 0 && b.y == 0);
      EXPECT_EQ(model[h / 3] >> h % 3 & 1, expected) << "half-edge " << h;
    }
  }
}

TEST(Cut, RefusesColumnsOfTheWrongLength) {
  Surface s = square_surface();
  std::vector<int> side;
  EXPECT_THROW(cut_by_scalar_field(s, {1, 2}, {}, side), std::logic_error);
  EXPECT_THROW(cut_by_scalar_field(s, {1, 2, 3, 4}, {1}, side), std::logic_error);
  EXPECT_THROW(cut_by_scalar_field(s, {1, 2, 3, std::nan("")}, {}, side), std::logic_error);
}

// random and smooth fields on a wavy grid, all or some of it active
TEST(Cut, KeepsTheSurfaceAndMakesNoSlivers) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int round = 0; round < 60; ++round) {
    Surface s = wavy_squares(8);
    const Surface before = s;
    std::vector<double> field(s.points.size());
    for (std::size_t v = 0; v < field.size(); ++v) {
      Vec3 p = s.points[v];
      field[v] = round % 3 == 0 ? uniform(random)
                 : round % 3 == 1
                     ? std::sin((3 + 0.2 * round) * p.x + round) - p.y + 0.3
                     : std::round(4 * uniform(random)) / 4 * (uniform(random) > 0 ? 1 : 0.01);  // many zeros
    }
    std::vector<char> active;
    if (round % 2)
      for (std::size_t t = 0; t < s.tris.size(); ++t) active.push_back(t % 5 != 0);
    std::vector<int> side;
    int added = cut_by_scalar_field(s, field, active, side, 0.1);
    ASSERT_EQ(s.points.size(), before.points.size() + added);
    EXPECT_TRUE(std::equal(before.points.begin(), before.points.end(), s.points.begin()));
    expect_oriented_manifold(s);
    EXPECT_EQ(euler(s), 1);
    EXPECT_NEAR(total_area(s), total_area(before), 1e-12);
    const auto& origin = s.face.get<int>("origin");
    std::vector<double> area(before.tris.size());
    for (std::size_t t = 0; t < s.tris.size(); ++t) {
      Vec3 n = area_vector(s.points[s.tris[t][0]], s.points[s.tris[t][1]], s.points[s.tris[t][2]]);
      const Tri& o = before.tris[origin[t]];
      Vec3 m = area_vector(before.points[o[0]], before.points[o[1]], before.points[o[2]]);
      EXPECT_GT(dot(n, m), 0);
      area[origin[t]] += norm(n) / norm(m);
      EXPECT_GT(norm(n) / norm(m), 0.1 * 0.1 - 1e-9);
      EXPECT_EQ(side[t] < 0, !active.empty() && !active[origin[t]]);
    }
    for (double a : area) EXPECT_NEAR(a, 1, 1e-12);
    EXPECT_GT(smallest_angle(s), 0.04);
    // sides differ only where the level is: at original vertices they agree with the field unless snapped
    if (round % 3 == 0)
      for (std::size_t t = 0; t < s.tris.size(); ++t)
        for (int v : s.tris[t]) {
          if (v < (int)field.size() && std::abs(field[v]) > 0.12 && side[t] >= 0) {
            EXPECT_EQ(side[t], field[v] > 0);
          }
        }
  }
}

TEST(Cut, DoesNotDependOnTheFirstCorners) {
  // the same surface with rotated corners gives the same set of points
  Surface a = wavy_squares(5), b = a;
  for (Tri& t : b.tris) t = {t[1], t[2], t[0]};
  std::vector<double> field;
  for (Vec3 p : a.points) field.push_back(p.x + 0.37 * p.y - 0.61);
  std::vector<int> side;
  cut_by_scalar_field(a, field, {}, side);
  cut_by_scalar_field(b, field, {}, side);
  EXPECT_EQ(a.points, b.points);
}
