// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/level_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lib/core/cut.h"
#include "lib/core/regions.h"
#include "lib/core/topology.h"
#include "lib/shape/shape.h"
#include "tests/unit/parts.h"
#include "tests/unit/spire.h"
#include "tests/unit/squares.h"

using namespace meshpipe;

namespace {

// n x n unit squares of two triangles, y folded up by 90 degrees beyond `fold`
Surface folded_squares(int n, double fold = 1e9) {
  Surface s;
  static_cast<Mesh&>(s) = unit_squares(n);
  for (Vec3& p : s.points) p = {p.x, std::min(p.y, fold), std::max(0., p.y - fold)};
  return s;
}

std::vector<double> field_of(const Mesh& m, const std::function<double(Vec3)>& f) {
  std::vector<double> field;
  for (Vec3 p : m.points) field.push_back(f(p));
  return field;
}

/// Cuts along the field's zero level, pulled straight; the sides become parts 0 and 1.
Surface cut_straight(const Surface& in, const std::vector<double>& field, int sweeps, double snap = 0.1,
                     const std::vector<LineVertex>& given = {}) {
  Surface s = in;
  LevelLine line = zero_level(s, field);
  const std::vector<LineVertex> hold =
      given.empty() ? std::vector<LineVertex>(field.size(), LineVertex::moves) : given;
  pull_straight({s, opposite_halfedges(s.tris, (int)s.points.size())}, line, hold, snap, sweeps);
  std::vector<int> side;
  std::vector<int> none;
  cut_along_line(CutSurface{s, none}, line, {}, side);
  s.face.set("part", side);
  return s;
}

}  // namespace

//    |  /\  /\  /       a wave of four edges, twice as long as high, through a plane: nothing is left of it,
//    | /  \/  \/        and it has passed over vertices; its ends meet the border at right angles
TEST(LevelLine, LosesItsTeeth) {
  const Surface plane = folded_squares(24);
  const auto wave = [](Vec3 p) { return p.x - 12.3 - 2 * std::sin(2 * 3.14159265 * p.y / 4); };
  const Interfaces before = measure_interfaces(cut_straight(plane, field_of(plane, wave), 0));
  const Surface after = cut_straight(plane, field_of(plane, wave), 100);
  EXPECT_GT(before.length * diagonal(plane), 40);
  EXPECT_GT(before.turning_angle, 60);
  EXPECT_EQ(part_fault(after), "");
  EXPECT_LT(measure_interfaces(after).length * diagonal(plane), 24.1);
  EXPECT_LT(measure_interfaces(after).turning_angle, 5);
  EXPECT_NEAR(total_area(after), 24 * 24, 1e-9);
}

// a circle shrinks a little where nothing holds it, and stays a circle
TEST(LevelLine, KeepsItsShapeInTheLarge) {
  const Surface plane = folded_squares(40);
  const auto circle = [](Vec3 p) { return 12.2 - std::hypot(p.x - 20.1, p.y - 19.8); };
  const Surface after = cut_straight(plane, field_of(plane, circle), 30);
  const double length = measure_interfaces(after).length * diagonal(plane);
  EXPECT_LT(length, 2 * 3.14159 * 12.2);
  EXPECT_GT(length, 2 * 3.14159 * 11.5);
  EXPECT_LT(measure_interfaces(after).turning_angle, 12);
}

// across a fold a line is straight on the surface, whatever it does in space
TEST(LevelLine, IsStraightAcrossAFold) {
  const Surface folded = folded_squares(20, 10), flat = folded_squares(20);
  auto slanted = [](Vec3 p) { return p.x - 4.37 - 0.5 * p.y; };
  const std::vector<double> field = field_of(flat, slanted);
  const Interfaces there = measure_interfaces(cut_straight(flat, field, 0, 0)),
                   here = measure_interfaces(cut_straight(folded, field, 0, 0));
  EXPECT_LT(here.largest_angle, 1e-5);
  EXPECT_NEAR(here.length * diagonal(folded), there.length * diagonal(flat), 1e-9);
}

//  2---3    no crossing comes closer to a vertex than the snap, and no triangle is inverted
TEST(LevelLine, RunsThroughVerticesOrPassesWellOff) {
  const Surface plane = folded_squares(24);
  LevelLine line = zero_level(plane, field_of(plane, [](Vec3 p) { return p.x - 9.03 - 0.3 * p.y; }));
  const std::vector<LineVertex> hold(plane.points.size(), LineVertex::moves);
  pull_straight({plane, opposite_halfedges(plane.tris, (int)plane.points.size())}, line, hold, 0.1, 30);
  int on = 0;
  for (signed char s : line.sign) on += s == 0;
  EXPECT_GT(on, 2);
  for (const EdgeCrossing& c : line.crossing) {
    EXPECT_EQ(line.sign[c.low] * line.sign[c.high], -1);
    EXPECT_GE(c.at, 0.1 - 1e-12);
    EXPECT_LE(c.at, 0.9 + 1e-12);
  }
}

// vertices that stay keep the line where it is
TEST(LevelLine, IsHeld) {
  const Surface plane = folded_squares(20);
  const std::vector<double> field = field_of(plane, [](Vec3 p) { return p.x - 9.6 - 0.8 * std::sin(p.y); });
  std::vector<LineVertex> hold(plane.points.size(), LineVertex::stays);
  Surface s = cut_straight(plane, field, 50, 0.1, hold);
  const std::vector<int>& side = s.face.get<int>("part");
  for (std::size_t t = 0; t < side.size(); ++t)
    for (int v : s.tris[t])
      if (v < (int)field.size()) {
        EXPECT_EQ(side[t], field[v] > 0);
      }
}

// a line that passes next to a slender peak runs through it, next to a blunt one it need not
TEST(LevelLine, RunsThroughASharpPeak) {
  for (double radius : {0.2, 8.0}) {
    const Surface cone = surface_of(spire(radius, 20, 24));
    const auto near = [&](Vec3 p) { return p.x - 0.021 * radius; };
    const Surface s = cut_straight(cone, field_of(cone, near), 0, 0);
    int sides = 0;
    for (std::size_t t = 0; t < s.tris.size(); ++t)
      for (int v : s.tris[t])
        if (v == 0) sides |= 1 << s.face.get<int>("part")[t];
    EXPECT_EQ(sides, radius < 1 ? 3 : 1) << radius;
    EXPECT_EQ(part_fault(s), "");
  }
}

// a rough tube of 20 triangles around, cut lengthwise by a ragged line, stays in two halves
TEST(LevelLine, KeepsTheTopologyOfBothSides) {
  Surface rough;
  static_cast<Mesh&>(rough) = tube(8, 20, false);
  add_noise(rough, 0.3, 1);
  for (int seed = 1; seed <= 5; ++seed) {
    std::vector<double> field;
    unsigned random = 77u * (unsigned)seed;
    for (Vec3 p : rough.points) {
      random = random * 1664525u + 1013904223u;
      field.push_back(p.y + 0.07 + 0.05 * ((random >> 8 & 255) / 255. - 0.5));
    }
    const Surface s = cut_straight(rough, field, 0), after = cut_straight(rough, field, 60);
    std::vector<int> before_part = s.face.get<int>("part"), after_part = after.face.get<int>("part");
    const auto pieces = [](const Surface& m, std::vector<int>& part) {
      return separate_pieces({m, opposite_halfedges(m.tris, (int)m.points.size())}, part);
    };
    EXPECT_EQ(pieces(s, before_part), pieces(after, after_part)) << seed;
  }
}
