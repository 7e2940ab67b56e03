// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/junctions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lib/core/junctions.h"
#include "lib/relax/operations.h"
#include "lib/relax/patch.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

/// Three strips of two rows of squares around the x axis, from x = 0 to 6, with edges of length 1.
Surface strips() {
  Surface s;
  constexpr int squares = 6, rows = 2;
  for (int sheet = 0; sheet < 3; ++sheet) {
    const double angle = 2 * M_PI / 3 * sheet;
    const int first = (int)s.points.size();
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= squares; ++i)
        s.points.push_back({(double)i, j * std::cos(angle), j * std::sin(angle)});
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < squares; ++i) {
        const int a = first + j * (squares + 1) + i, b = a + squares + 1;
        s.tris.push_back({a, a + 1, b + 1});
        s.tris.push_back({a, b + 1, b});
      }
  }
  for (Vec3& p : s.points)
    for (double* x : {&p.y, &p.z})
      if (std::abs(*x) < 1e-12) *x = 0;
  s.vertex.rows = s.points.size();
  s.vertex.set("size", std::vector<double>(s.points.size(), 1));
  s.face.set("patch", std::vector<int>(s.tris.size(), 1));
  return s;
}

struct Strips {
  explicit Strips(Surface of = strips())
      : surface(std::move(of)), reference(surface), lifted(lifted_of(surface)), s(started()) {}
  State started() {
    LiftedMesh mesh = lifted;
    return start_state(mesh, reference, {}, {}, true);
  }
  int edge(int a, int b) const {
    for (int h = 0; h < (int)s.mesh.opp.size(); ++h)
      if (!s.mesh.dead(h / 3) && s.mesh.from(h) == a && s.mesh.to(h) == b) return h;
    return -1;
  }
  int copies(int v) const {
    int n = 0;
    for_copies(s, v, [&](int c) {
      EXPECT_EQ(s.points[c], s.points[v]);
      ++n;
    });
    return n;
  }
  Surface surface;
  Reference reference;
  LiftedMesh lifted;
  State s;
};

constexpr int per_sheet = 21;

TEST(Copies, VerticesWhereSheetsMeetSlideExceptAtTheirEnds) {
  const Strips m;
  for (int v : {3, 3 + per_sheet, 3 + 2 * per_sheet}) {
    EXPECT_EQ(m.copies(v), 3);
    EXPECT_EQ(m.s.hold[v], slides);
  }
  EXPECT_EQ(m.s.hold[0], fixed);
  EXPECT_FALSE(is_shared(m.s, 10));
}

TEST(Copies, AVertexSlidesWithItsCopies) {
  Strips m;
  for (int v : {3, 3 + per_sheet, 3 + 2 * per_sheet}) {
    m.s.points[v].x = 3.3;
    m.s.place[v] = m.reference.walk.slide(m.s.place[v], m.s.points[v]);
  }
  ASSERT_TRUE(slide_vertex(m.s, 3 + per_sheet));
  EXPECT_LT(std::abs(m.s.points[3].x - 3), 0.29);
  EXPECT_EQ(m.copies(3), 3);
  smooth(m.s, 3);
  EXPECT_EQ(m.copies(3), 3);
}

TEST(Copies, AnEdgeIsSplitAndCollapsedInAllSheets) {
  Strips m;
  const int n = (int)m.s.points.size();
  ASSERT_TRUE(split_edge(m.s, m.edge(2, 3), 0.4));
  ASSERT_EQ((int)m.s.points.size(), n + 3);
  EXPECT_EQ(m.copies(n), 3);
  EXPECT_EQ(m.s.mesh.live, 3 * 24 + 3);
  ASSERT_TRUE(collapse_edge(m.s, m.edge(n, 3), n, {1e9, 3}));
  EXPECT_EQ(m.s.mesh.live, 3 * 24);
  for (int v : {n, n + 1, n + 2}) EXPECT_LT(m.s.mesh.out[v], 0);
  EXPECT_FALSE(collapse_edge(m.s, m.edge(0, 1), 0, {1e9, 3}));
}

//  a fin stands on the slit from b to d of a sheet, whose middle vertex c is there for each of its sides
//   +--+--+--+--+
//   |  | above  |
//   +--b--c--d--+
//   |  | below  |
//   +--+--+--+--+
constexpr int below = 7, above = 15;  // c

Surface with_slit(bool has_fin) {
  Surface s;
  for (int j = -1; j <= 1; ++j)
    for (int i = 0; i <= 4; ++i) s.points.push_back({(double)i, (double)j, 0});
  s.points.push_back(s.points[below]);
  auto square = [&](int a, int b, int c, int d) {
    s.tris.push_back({a, b, c});
    s.tris.push_back({a, c, d});
  };
  auto upper = [&](int v) { return v == below ? above : v; };
  for (int i = 0; i < 4; ++i) {
    square(i, i + 1, i + 6, i + 5);
    square(upper(i + 5), upper(i + 6), i + 11, i + 10);
  }
  const int fin = above + 1;
  for (int k = 0; k < 2 && has_fin; ++k)
    for (int i = 1; i <= 3; ++i) s.points.push_back({(double)i, 0, (double)k});
  for (int i = fin; i < fin + 2 && has_fin; ++i) square(i, i + 1, i + 4, i + 3);
  s.vertex.rows = s.points.size();
  s.vertex.set("size", std::vector<double>(s.points.size(), 2));
  s.face.set("patch", std::vector<int>(s.tris.size(), 1));
  return s;
}

TEST(Copies, ASlitKeepsAVertexBetweenItsEnds) {
  constexpr int fin = above + 1;
  Strips m(with_slit(true));
  ASSERT_EQ(m.copies(below), 3);
  for (int c : {below, above, fin + 1}) m.s.hold[c] = slides;
  EXPECT_FALSE(collapse_edge(m.s, m.edge(below, below - 1), below, {1e9, 9}));
  ASSERT_TRUE(split_edge(m.s, m.edge(below + 1, below)));
  EXPECT_TRUE(collapse_edge(m.s, m.edge(fin + 6, below), fin + 6, {1e9, 9}));
  EXPECT_EQ(m.copies(below), 3);
}

TEST(Copies, ASlitIsSplitOnBothSidesAlsoAtItsEnds) {
  Strips m(with_slit(false));
  const int n = (int)m.s.points.size();
  ASSERT_FALSE(is_shared(m.s, below + 1));
  ASSERT_TRUE(split_edge(m.s, m.edge(below + 1, below)));
  ASSERT_EQ((int)m.s.points.size(), n + 2);
  EXPECT_EQ(m.copies(n), 2);
  for (int c : {below, above}) m.s.hold[c] = slides;
  EXPECT_TRUE(collapse_edge(m.s, m.edge(n, below), n, {1e9, 9}));
  EXPECT_EQ(m.s.mesh.live, 16);
  EXPECT_FALSE(collapse_edge(m.s, m.edge(below, below - 1), below - 1, {1e9, 9}));
}

/// Edges inside a sheet that another one has, too.
int double_edges(const State& s) {
  int n = 0;
  for (int h = 0; h < (int)s.mesh.opp.size(); ++h)
    n += h < s.mesh.opp[h] && joined_elsewhere(s, s.mesh.from(h), s.mesh.to(h));
  return n;
}

TEST(Copies, DoubleEdgesAreParted) {
  // two squares that share three sides, each divided along the same diagonal
  Surface s;
  for (double z : {0.0, 0.1}) {
    const int first = (int)s.points.size();
    for (Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, z}}) s.points.push_back(p);
    s.tris.push_back({first, first + 1, first + 2});
    s.tris.push_back({first, first + 2, first + 3});
  }
  s.vertex.rows = s.points.size();
  s.vertex.set("size", std::vector<double>(s.points.size(), 1));
  const Reference reference(s);
  LiftedMesh mesh = lifted_of(s);
  State state = start_state(mesh, reference, {}, {}, true);
  EXPECT_EQ(double_edges(state), 2);
  part_double_edges(state);
  EXPECT_EQ(double_edges(state), 0);
}

TEST(Copies, AnEdgeThatOneSheetHasOutsideOfAPatchIsHeld) {
  Strips m;
  std::vector<int> all, without;
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int v : {2, 3}) m.s.mesh.star(v + sheet * per_sheet, [&](int h) { all.push_back(h / 3); });
  sort_unique(all);
  const int outside = m.edge(2 + 2 * per_sheet, 3 + 2 * per_sheet) / 3;
  for (int t : all)
    if (t != outside) without.push_back(t);
  auto splits = [&](const std::vector<int>& triangles) {
    State patch = extract(m.s, triangles);
    const int at = (int)(std::find(triangles.begin(), triangles.end(), m.edge(2, 3) / 3) - triangles.begin());
    return split_edge(patch, 3 * at + m.edge(2, 3) % 3);
  };
  EXPECT_TRUE(splits(all));
  EXPECT_FALSE(splits(without));
}

TEST(Copies, PatchesHoldAllSheets) {
  Strips m;
  const std::vector<int> found = triangles_around(m.s, m.edge(2, 3) / 3, 1);
  std::vector<int> sheets(3, 0);
  for (int t : found) ++sheets[t / 24];
  for (int n : sheets) EXPECT_GT(n, 2);
  const State patch = extract(m.s, found);
  int complete = 0;
  for (int v = 0; v < (int)patch.points.size(); ++v)
    complete += is_shared(patch, v) && patch.hold[v] == slides;
  EXPECT_EQ(complete, 6);  // both ends of the edge, three times each
}

}  // namespace
