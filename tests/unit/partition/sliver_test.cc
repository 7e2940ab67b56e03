// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/core/cut.h"
#include "lib/core/topology.h"
#include "lib/partition/partition.h"
#include "tests/unit/squares.h"

using namespace meshpipe;

namespace {

constexpr int n = 20;

//   0    part    0 | 1
//                | |         a model edge at x = 10, and a cut through the triangles to its right:
//   y            | |         part 1 beyond it, part_of(y) on the left, 0 between the two
//   ^            | |
//   +--> x      10 cut
Surface cut_next_to_an_edge(double cut, int (*part_of)(double)) {
  Surface s;
  static_cast<Mesh&>(s) = unit_squares(n);
  std::vector<std::uint8_t> model(s.tris.size(), 0);
  for (int h = 0; h < (int)(3 * s.tris.size()); ++h)
    if (s.points[origin(s.tris, h)].x == 10 && s.points[target(s.tris, h)].x == 10)
      model[h / 3] |= 1 << h % 3;
  s.face.set("model", std::move(model));
  std::vector<double> field;
  for (Vec3 p : s.points) field.push_back(p.x - cut);
  std::vector<int> side;
  cut_by_scalar_field(s, field, {}, side, 0.1);
  for (std::size_t t = 0; t < side.size(); ++t) {
    const Vec3 sum = s.points[s.tris[t][0]] + s.points[s.tris[t][1]] + s.points[s.tris[t][2]];
    if (sum.x < 30) side[t] = part_of(sum.y / 3);
  }
  s.face.set("part", std::move(side));
  return s;
}

int left(double) { return 0; }
int left_except_the_middle(double y) { return y < 5 || y > 15 ? 0 : 2; }

bool hand_over(Surface& s, int n_parts, int max_faces = 0) {
  std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  return hand_over_slivers({s, opposite}, n_parts, max_faces);
}

double area_of_part(const Surface& s, int part) {
  double sum = 0;
  for (std::size_t t = 0; t < s.tris.size(); ++t)
    if (s.face.get<int>("part")[t] == part)
      sum += 0.5 * norm(area_vector(s.points[s.tris[t][0]], s.points[s.tris[t][1]], s.points[s.tris[t][2]]));
  return sum;
}

}  // namespace

TEST(Sliver, GoesToTheOtherSideOfItsCut) {
  Surface s = cut_next_to_an_edge(10.15, left);
  EXPECT_NEAR(area_of_part(s, 0), 203, 1e-9);
  EXPECT_TRUE(hand_over(s, 2));
  EXPECT_NEAR(area_of_part(s, 0), 200, 1e-9);
  EXPECT_EQ(part_fault(s), "");
  EXPECT_FALSE(hand_over(s, 2));
}

TEST(Sliver, OriginsOnlyTellTrianglesApart) {
  Surface s = cut_next_to_an_edge(10.15, left), odd = s;
  std::vector<int> origin = odd.face.get<int>("origin");
  for (int& o : origin) o = o % 2 ? -o : 2147483647 - o;
  odd.face.set("origin", std::move(origin));
  EXPECT_TRUE(hand_over(s, 2));
  EXPECT_TRUE(hand_over(odd, 2));
  EXPECT_EQ(odd.face.get<int>("part"), s.face.get<int>("part"));
}

TEST(Sliver, IsThinnerThanTheTriangles) {
  Surface s = cut_next_to_an_edge(10.5, left);
  EXPECT_FALSE(hand_over(s, 2));
  EXPECT_NEAR(area_of_part(s, 0), 210, 1e-9);
}

TEST(Sliver, StaysWhereItHoldsAPartTogether) {
  Surface s = cut_next_to_an_edge(10.15, left_except_the_middle);
  ASSERT_EQ(part_fault(s), "");
  EXPECT_FALSE(hand_over(s, 3));
  EXPECT_NEAR(area_of_part(s, 0), 103, 1e-9);
}

TEST(Sliver, StaysWhereTheOtherPartHasNoSpace) {
  Surface s = cut_next_to_an_edge(10.15, left);
  const auto& part = s.face.get<int>("part");
  EXPECT_FALSE(hand_over(s, 2, (int)std::count(part.begin(), part.end(), 1)));
  EXPECT_NEAR(area_of_part(s, 0), 203, 1e-9);
}

TEST(Sliver, NeedsAModelEdge) {
  Surface s = cut_next_to_an_edge(10.15, left);
  auto& model = s.face.get<std::uint8_t>("model");
  std::fill(model.begin(), model.end(), 0);
  EXPECT_FALSE(hand_over(s, 2));
}
