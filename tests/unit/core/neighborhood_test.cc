// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/neighborhood.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lib/core/connectivity.h"
#include "lib/core/cut.h"
#include "lib/core/topology.h"
#include "tests/unit/squares.h"

using namespace meshpipe;

namespace {

// 12 x 12 squares, three parts in stripes, with columns of both kinds
struct Whole {
  Surface surface = surface_of(unit_squares(12));
  std::vector<int> opposite;

  Whole() {
    std::vector<int> part;
    std::vector<double> height;
    for (const Tri& t : surface.tris) part.push_back((int)surface.points[t[0]].x / 4);
    for (const Vec3& p : surface.points) height.push_back(p.x + 0.1 * p.y);
    surface.face.set("part", std::move(part));
    surface.vertex.set("height", std::move(height));
    name_origins(surface);
    opposite = opposite_halfedges(surface.tris, (int)surface.points.size());
  }
};

/// Cuts part 1 along a wave.
void cut_part_1(Surface& s, std::vector<int>& opposite) {
  const std::vector<int> label = s.face.get<int>("part");
  std::vector<char> active;
  for (int l : label) active.push_back(l == 1);
  const ConnectedPart part = select_part({s, opposite}, label, 1);
  std::vector<double> field;
  for (const Vec3& p : part.points) field.push_back(p.y - 5.7 - 1.3 * std::sin(p.x));
  std::vector<int> side;
  cut_along_line(CutSurface{s, opposite}, in_whole(zero_level(part, field), part.vertex, s.points.size()),
                 active, side);
  std::vector<int>& now = s.face.get<int>("part");
  for (std::size_t t = 0; t < side.size(); ++t)
    if (side[t] == 1) now[t] = 7;
}

TEST(Neighborhood, ComesBackAsItWas) {
  Whole whole, same;
  const auto near =
      take_neighborhood({whole.surface, whole.opposite}, whole.surface.face.get<int>("part"), 1);
  EXPECT_LT(near.face.size(), 0.6 * (double)whole.surface.tris.size());
  put_back(near, {whole.surface, whole.opposite});
  EXPECT_EQ(whole.surface.tris, same.surface.tris);
  EXPECT_EQ(whole.opposite, same.opposite);
}

TEST(Neighborhood, ACutOfItIsThatOfTheWhole) {
  Whole whole, local;
  cut_part_1(whole.surface, whole.opposite);
  auto near = take_neighborhood({local.surface, local.opposite}, local.surface.face.get<int>("part"), 1);
  cut_part_1(near.surface, near.opposite);
  put_back(near, {local.surface, local.opposite});
  ASSERT_GT(whole.surface.points.size(), 13u * 13u);
  EXPECT_EQ(local.surface.points, whole.surface.points);
  EXPECT_EQ(local.surface.tris, whole.surface.tris);
  EXPECT_EQ(local.opposite, whole.opposite);
  EXPECT_EQ(local.opposite, opposite_halfedges(local.surface.tris, (int)local.surface.points.size()));
  EXPECT_EQ(local.surface.vertex.get<double>("height"), whole.surface.vertex.get<double>("height"));
  for (const char* column : {"part", "origin"})
    EXPECT_EQ(local.surface.face.get<int>(column), whole.surface.face.get<int>(column)) << column;
}

}  // namespace
