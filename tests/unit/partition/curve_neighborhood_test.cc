// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/curve_neighborhood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lib/core/topology.h"
#include "tests/unit/parts.h"
#include "tests/unit/squares.h"

using namespace meshpipe;

namespace {

//  0 | 1 | 2   stripes of 10 x 30 unit squares: square (x, y) has the triangles 2 (30 y + x) and the next
struct Stripes {
  Surface surface = surface_of(unit_squares(30));
  std::vector<int> opposite = opposite_halfedges(surface.tris, (int)surface.points.size());
  CutSurface cut() { return {surface, opposite}; }
  std::vector<int>& part() { return surface.face.get<int>("part"); }
  Stripes() {
    std::vector<int> part;
    for (int t = 0; t < (int)surface.tris.size(); ++t) part.push_back(t / 2 % 30 / 10);
    surface.face.set("part", std::move(part));
  }
};

/// The parts that are broken once a triangle of the neighborhood of both curves has another part.
std::vector<char> broken_by(int square, int to, int max_faces = 0) {
  Stripes whole;
  std::vector<CurveNeighborhood> near =
      take_curve_neighborhoods(whole.cut(), find_curves(whole.cut()), 6, max_faces);
  EXPECT_EQ(near.size(), 1u);
  const Connectivity mesh = near[0].cut().connectivity();
  std::vector<int> part = near[0].surface.face.get<int>("part");
  const PartTopologies before = topology_of_parts_in(near[0], mesh, part);
  for (int t = 0; t < (int)part.size(); ++t)
    if (near[0].face[t] == 2 * square) part[t] = to;
  return broken_parts(before, topology_of_parts_in(near[0], mesh, part), part, near[0]);
}

}  // namespace

TEST(CurveNeighborhood, ThatOfEachCurveWhereTheyAreApart) {
  Stripes whole;
  const Stripes same;
  std::vector<CurveNeighborhood> near = take_curve_neighborhoods(whole.cut(), find_curves(whole.cut()), 3, 0);
  ASSERT_EQ(near.size(), 2u);
  EXPECT_EQ(near[0].parts, (std::vector<int>{0, 1}));
  EXPECT_EQ(near[1].parts, (std::vector<int>{1, 2}));
  for (CurveNeighborhood& n : near) {
    EXPECT_EQ(n.handles.size(), 1u);
    EXPECT_EQ(find_curves(n.cut()).size(), 1u);
    EXPECT_TRUE(has_handle(n.surface, find_curves(n.cut())[0], n.handles));
    for (int h : n.anchors)
      EXPECT_NEAR(std::abs(whole.surface.points[whole.surface.tris[n.face[h / 3]][0]].x - 15), 5, 5);
    put_back(n, whole.cut());
  }
  EXPECT_EQ(whole.surface.tris, same.surface.tris);
  EXPECT_EQ(whole.part(), same.surface.face.get<int>("part"));
  EXPECT_EQ(whole.opposite, same.opposite);
}

TEST(CurveNeighborhood, APartIsBrokenByAnIsland) {
  EXPECT_EQ(broken_by(30 * 15 + 13, 0), (std::vector<char>{1, 0, 0}));  // 1 has a hole more, as it may
}

//   |/    the triangle c b a has the corner a on the interface x = 10
//   a---b
TEST(CurveNeighborhood, APartIsBrokenWhereItTouchesItself) {
  EXPECT_EQ(broken_by(30 * 15 + 10, 2), (std::vector<char>{0, 1, 1}));
  EXPECT_EQ(broken_by(30 * 15 + 9, 1), (std::vector<char>{0, 0, 0}));  // it has an edge on it
}

TEST(CurveNeighborhood, APartIsBrokenByTooManyTriangles) {
  EXPECT_EQ(broken_by(30 * 15 + 9, 1, 601), (std::vector<char>{0, 0, 0}));
  EXPECT_EQ(broken_by(30 * 15 + 9, 1, 600), (std::vector<char>{0, 1, 0}));
}

//  a torus along which runs a strip of part 0; parts 1 and 2 share the rest. If 1 gives its end next to 2 to
//  part 0, that has the same genus in the neighborhood of 0 | 1, but a handle as a whole
TEST(CurveNeighborhood, APartIsBrokenByAHandleThatOnlyTheWholeHas) {
  constexpr int along = 120, around = 18;
  Surface s;
  std::vector<int> part, ring;
  const double r = around / (2 * std::numbers::pi), far = along / (2 * std::numbers::pi) + r;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      const double u = 2 * std::numbers::pi * i / along, v = 2 * std::numbers::pi * j / around;
      const double x = far + r * std::cos(v);
      s.points.push_back({x * std::cos(u), x * std::sin(u), r * std::sin(v)});
      auto at = [&](int k, int l) { return k % along * around + l % around; };
      s.tris.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.tris.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      part.insert(part.end(), 2, j < around / 3 ? 0 : i < 20 ? 1 : 2);
      ring.insert(ring.end(), 2, i);
    }
  s.face.set("part", part);
  std::vector<int> opposite = opposite_halfedges(s);
  ASSERT_EQ(part_fault(s), "");
  std::vector<Curve> curves = find_curves({s, opposite});
  std::erase_if(curves, [](const Curve& c) { return c.a != 0 || c.b != 1; });
  CurveNeighborhood near = std::move(take_curve_neighborhoods({s, opposite}, curves, 14, 0)[0]);
  const Connectivity mesh = near.cut().connectivity();
  std::vector<int>& here = near.surface.face.get<int>("part");
  const PartTopologies before = topology_of_parts_in(near, mesh, here);
  for (int t = 0; t < (int)here.size(); ++t)
    if (ring[near.face[t]] < 2 && here[t] == 1) here[t] = 0;
  EXPECT_EQ(broken_parts(before, topology_of_parts_in(near, mesh, here), here, near)[0], 1);
  put_back(near, {s, opposite});
  EXPECT_EQ(part_fault(s), "part 0 has genus 1");
}
