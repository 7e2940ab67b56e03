// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/handles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/core/regions.h"
#include "lib/core/topology.h"

using namespace meshpipe;

namespace {

constexpr double full_turn = 2 * std::numbers::pi;

Mesh ring(int n, int m) {
  Mesh s;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = full_turn * i / n, y = full_turn * j / m, r = 2 + 0.7 * std::cos(y);
      s.points.push_back({r * std::cos(x), r * std::sin(x), 0.7 * std::sin(y)});
    }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * n + i, b = j * n + (i + 1) % n, c = (j + 1) % m * n + (i + 1) % n,
                d = (j + 1) % m * n + i;
      s.tris.push_back({a, b, c});
      s.tris.push_back({a, c, d});
    }
  return s;
}

}  // namespace

// The shortest loop that leaves a torus in one piece goes once round its tube; its two sides are rings.
TEST(Handles, ATorusIsCutRoundItsTube) {
  const Mesh m = ring(60, 24);
  const auto opposite = opposite_halfedges(m.tris, (int)m.points.size());
  const auto loops = handle_loops({m, opposite}, 1);
  ASSERT_EQ(loops.size(), 1u);
  double length = 0;
  for (std::size_t i = 0; i < loops[0].size(); ++i) {
    const int h = loops[0][i];
    EXPECT_EQ(target(m.tris, h), origin(m.tris, loops[0][(i + 1) % loops[0].size()]));
    length += norm(m.points[target(m.tris, h)] - m.points[origin(m.tris, h)]);
  }
  EXPECT_LT(length, 1.1 * full_turn * 0.7);
  std::vector<int> label = label_by_sides({m, opposite}, loops);
  EXPECT_EQ(*std::min_element(label.begin(), label.end()), 0);
  EXPECT_EQ(*std::max_element(label.begin(), label.end()), 1);
  for (int h : loops[0]) EXPECT_NE(label[h / 3], label[opposite[h] / 3]);
  for (const Region& r : find_regions({m, opposite}, label, 2).region) EXPECT_TRUE(r.maps_to_the_plane());
}

// No loop where there is no handle left, and none round a border.
TEST(Handles, NoMoreLoopsThanHandles) {
  Mesh m = ring(30, 12);
  m.tris.erase(m.tris.begin() + 100, m.tris.begin() + 102);
  const auto opposite = opposite_halfedges(m.tris, (int)m.points.size());
  EXPECT_EQ(handle_loops({m, opposite}, 2).size(), 1u);
}
