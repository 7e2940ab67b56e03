// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/clean/clean.h"
#include "lib/core/connectivity.h"
#include "lib/core/edges.h"
#include "lib/core/junctions.h"
#include "lib/shape/shape.h"
#include "lib/smooth/smooth.h"
#include "lib/solids/solids.h"

using namespace meshpipe;

TEST(SmoothSheets, StaysConformingWithinTheBound) {
  Surface s = surface_of(labeled_image(3, true, true, 4000, 1));
  clean(s, {.sheets = CleanOptions::keep});
  take_apart(s);
  const std::vector<Vec3> before = s.points;
  Mesh joined = s;
  join_borders(joined);
  const SmoothReport r = smooth_sheets(s, {});
  Mesh after = s;
  join_borders(after);
  EXPECT_EQ(after.tris, joined.tris);
  EXPECT_LT(r.angle_after, 0.5 * r.angle_before);
  EXPECT_GT(r.farthest, 0);
  for (std::size_t v = 0; v < before.size(); ++v)
    EXPECT_LE(norm(s.points[v] - before[v]), r.within * (1 + 1e-12));
  EXPECT_LT(r.region_change, 1e-3);
}

/// Triangles with two edges where more than two meet, and the length of all such edges.
static std::pair<int, double> ears(const Mesh& mesh) {
  std::vector<int> on_line(mesh.tris.size(), 0);
  double length = 0;
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    if (uses.size() < 3) return;
    length += edge_length(mesh, half_edge(uses[0]));
    for (EdgeUse e : uses) ++on_line[half_edge(e) / 3];
  });
  return {(int)std::count(on_line.begin(), on_line.end(), 2), length};
}

TEST(SmoothSheets, LinesBecomeStraightWithoutFolds) {
  const Surface blocks = surface_of(labeled_image(2, true, true, 6000, 1));
  Surface s = blocks;
  EXPECT_GT(ears(s).first, 40);
  flip_ears(s);
  EXPECT_EQ(ears(s).first, 0);
  EXPECT_EQ(ears(s).second, ears(blocks).second);
  const Solids before = find_solids(blocks), after = find_solids(s);
  ASSERT_EQ(after.count(), before.count());
  for (int i = 1; i <= before.count(); ++i) EXPECT_NEAR(after.volume[i], before.volume[i], 1e-12);
  const SmoothReport r = smooth_sheets(s, {});
  EXPECT_EQ(r.moved_back, 0);
  EXPECT_LT(ears(s).second, 2 * 3.15 * 1.1);  // little more than the circle where the plane meets the ball
  // those on model edges stay
  Surface marked = blocks;
  marked.face.set("model", std::vector<std::uint8_t>(blocks.tris.size(), 7));
  flip_ears(marked);
  EXPECT_EQ(marked.tris, blocks.tris);
}

TEST(SmoothSheets, KeepsShortLines) {
  Surface s = surface_of(labeled_image(8, false, true, 10000, 1));
  const std::vector<Vec3> before = s.points;
  struct Short {
    int a, b;
  };
  std::vector<int> lines(s.points.size(), 0);
  std::vector<Short> edges;
  for_each_edge(s.tris, (int)s.points.size(), [&](std::span<const EdgeUse> uses) {
    if (uses.size() < 3) return;
    const int h = half_edge(uses[0]);
    edges.push_back({origin(s.tris, h), target(s.tris, h)});
    ++lines[edges.back().a], ++lines[edges.back().b];
  });
  smooth_sheets(s, {});
  int found = 0;
  for (const Short& e : edges) {
    if (lines[e.a] == 2 || lines[e.b] == 2) continue;
    ++found;
    EXPECT_GT(norm(s.points[e.a] - s.points[e.b]), 0.5 * norm(before[e.a] - before[e.b]));
  }
  EXPECT_GT(found, 0);
}
