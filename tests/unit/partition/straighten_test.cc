// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lib/core/topology.h"
#include "tests/unit/parts.h"

using namespace meshpipe;

namespace {

// n x n unit squares of two triangles; part(x, y) of each square
Surface grid(int n, int (*part_of)(int, int)) {
  Surface s;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) s.points.push_back({(double)x, (double)y, 0});
  std::vector<int> part;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      int a = y * (n + 1) + x, b = a + 1, c = b + n + 1, d = a + n + 1;
      s.tris.push_back({a, b, c});
      s.tris.push_back({a, c, d});
      part.insert(part.end(), 2, part_of(x, y));
    }
  s.face.set("part", std::move(part));
  return s;
}

//  aaabbb
//  aabbbb    the teeth of a saw
//  aaabbb
int saw(int x, int y) { return x < 10 + y % 2 ? 0 : 1; }

void straighten(Surface& s, int n_parts, double snap) {
  std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  straighten_interfaces({s, opposite}, n_parts, snap);
  EXPECT_EQ(opposite, opposite_halfedges(s.tris, (int)s.points.size()));
}

}  // namespace

TEST(Straighten, FlattensASaw) {
  Surface s = grid(20, saw);
  const Interfaces before = measure_interfaces(s);
  EXPECT_NEAR(before.length * diagonal(s), 39, 1e-9);
  straighten(s, 2, 0.1);
  const Interfaces after = measure_interfaces(s);
  EXPECT_EQ(part_fault(s), "");
  EXPECT_LT(after.length * diagonal(s), 20.5);
  EXPECT_GE(after.length * diagonal(s), 20 - 1e-9);
  EXPECT_LT(after.turning_angle, 10);
  EXPECT_NEAR(total_area(s), 400, 1e-9);
}

TEST(Straighten, LeavesModelEdgesAlone) {
  Surface s = grid(20, saw);
  // the lower half of the saw is a model edge
  const auto opposite = opposite_halfedges(s.tris, (int)s.points.size());
  std::vector<std::uint8_t> model(s.tris.size(), 0);
  const auto part = s.face.get<int>("part");
  int n = 0;
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] >= 0 && part[h / 3] != part[opposite[h] / 3] &&
        s.points[origin(s.tris, h)].y + s.points[target(s.tris, h)].y < 20)
      model[h / 3] |= 1 << h % 3, ++n;
  s.face.set("model", model);
  const double length = measure_interfaces(s).length;
  straighten(s, 2, 0.1);
  EXPECT_EQ(part_fault(s), "");
  EXPECT_LT(measure_interfaces(s).length, 0.9 * length);  // the upper half has changed
  const auto now = opposite_halfedges(s.tris, (int)s.points.size());
  int kept = 0;
  for (int h = 0; h < (int)now.size(); ++h)
    if (s.face.get<std::uint8_t>("model")[h / 3] >> h % 3 & 1)
      kept += s.face.get<int>("part")[h / 3] != s.face.get<int>("part")[now[h] / 3];
  EXPECT_EQ(kept, n);
}

//  2222    three parts meet in a junction
//  0011
TEST(Straighten, KeepsJunctionsValid) {
  Surface s = grid(20, [](int x, int y) { return y >= 10 + x % 3 ? 2 : saw(x, y); });
  ASSERT_EQ(part_fault(s), "");
  const double length = measure_interfaces(s).length;
  straighten(s, 3, 0.1);
  EXPECT_EQ(part_fault(s), "");
  EXPECT_EQ(measure_interfaces(s).junctions, 1);
  EXPECT_LT(measure_interfaces(s).length, 0.75 * length);
}

//  0 | 1 | 2   both saws are straightened by themselves, and share what part 1 may still get
TEST(Straighten, BoundsTheTrianglesOfAPartThatTwoCurvesShare) {
  for (int more : {0, 20, 40, 60}) {
    Surface s = grid(120, [](int x, int y) { return x < 30 + y % 2 ? 0 : x < 90 - y % 2 ? 1 : 2; });
    auto faces = [&] {
      const std::vector<int>& part = s.face.get<int>("part");
      return (int)std::count(part.begin(), part.end(), 1);
    };
    const int most = faces() + more;
    std::vector<int> opposite = opposite_halfedges(s);
    straighten_interfaces({s, opposite}, 3, 0.1, most);
    EXPECT_LE(faces(), most);
    EXPECT_EQ(part_fault(s), "");
    EXPECT_EQ(opposite, opposite_halfedges(s));
  }
}

//  a strip of part 0 one triangle wide would vanish: it has to stay
TEST(Straighten, DoesNotLoseAPart) {
  Surface s = grid(20, [](int x, int y) { return x < 10 + y % 2 ? 1 : x == 10 + y % 2 ? 0 : 2; });
  straighten(s, 3, 0.1);
  EXPECT_EQ(part_fault(s), "");
}

//  a quarter of a fan of large triangles: its corner at the middle becomes a chord
TEST(Straighten, CutsACornerAcrossAFan) {
  Surface s;
  constexpr int n = 24;
  s.points.push_back({0, 0, 0});
  std::vector<int> part;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * 3.14159265358979 * i / n;
    s.points.push_back({std::cos(a), std::sin(a), 0});
    s.tris.push_back({0, 1 + i, 1 + (i + 1) % n});
    part.push_back(i < n / 4);
  }
  s.face.set("part", part);
  straighten(s, 2, 0.1);
  EXPECT_EQ(part_fault(s), "");
  EXPECT_LT(measure_interfaces(s).length * diagonal(s), 1.5);
  EXPECT_LT(measure_interfaces(s).largest_angle, 20);
}

//  a spike of one triangle on a straight interface is given to the other part
TEST(Straighten, TrimsASpike) {
  Surface s = grid(20, [](int x, int) { return x < 10 ? 0 : 1; });
  s.face.get<int>("part")[2 * (7 * 20 + 10)] = 0;
  const double length = measure_interfaces(s).length * diagonal(s);
  EXPECT_GT(length, 20.1);
  straighten(s, 2, 0.1);
  EXPECT_EQ(part_fault(s), "");
  EXPECT_LT(measure_interfaces(s).length * diagonal(s), 20.01);
}
