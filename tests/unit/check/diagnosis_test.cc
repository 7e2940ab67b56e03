// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/check/check.h"
#include "lib/core/intersect.h"

using namespace meshpipe;

static Surface surface(std::vector<Vec3> points, std::vector<Tri> tris) {
  Mesh mesh;
  mesh.points = std::move(points);
  mesh.tris = std::move(tris);
  return surface_of(std::move(mesh));
}

/// A flat strip of n unit squares, its last two columns of points `gap` apart.
static Surface strip(int n, double gap) {
  std::vector<Vec3> points;
  std::vector<Tri> tris;
  for (int i = 0; i <= n; ++i)
    for (double y : {0., 1.}) points.push_back({i < n ? i : n - 1 + gap, y, 0});
  for (int i = 0; i < n; ++i) {
    tris.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    tris.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  return surface(points, tris);
}

TEST(Diagnosis, FindsPointsThatAreAlmostOne) {
  const Diagnosis d = diagnose(strip(10, 1e-6), {}, 0);
  EXPECT_EQ(d.short_edges, 2u);
  EXPECT_GT(d.weld, 1e-6);
  EXPECT_LT(d.weld, d.next_edge / 2);
  EXPECT_EQ(d.next_edge, 1);
  EXPECT_EQ(diagnose(strip(10, 0.1), {}, 0).weld, 0);
}

TEST(Diagnosis, CountsIntersectionsAndSaysWhere) {
  const Surface s =
      surface({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {1, 9, 0}}, {{0, 1, 2}, {3, 4, 5}});
  const Diagnosis d = diagnose(s, {}, 0);
  EXPECT_EQ(d.intersections, 1u);
  EXPECT_NEAR(d.intersection.x, 1, 1e-12);
  EXPECT_NEAR(d.intersection.z, 0, 1e-12);
}

TEST(Diagnosis, BodiesThatTouchDoNotIntersect) {
  const Surface s =
      surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}, {3, 4, 5}});
  ASSERT_EQ(self_intersections(s).size(), 1u);
  EXPECT_EQ(diagnose(s, {}, 0).intersections, 0u);
}

TEST(Diagnosis, KnowsTheLinesNextToAPlace) {
  Surface s = strip(10, 1);
  s.face.set("patch", std::vector<int>(20, 1));
  for (int t = 10; t < 20; ++t) s.face.get<int>("patch")[t] = 2;
  std::vector<std::uint8_t> model(20, 0);
  model[6] = 4;  // the diagonal of the fourth square
  s.face.set("model", model);
  const Diagnosis patches = diagnose(s, {5.1, 0.5, 0}, 0.3);
  EXPECT_TRUE(patches.at_patch_border && !patches.at_crease && !patches.at_border);
  const Diagnosis crease = diagnose(s, {3.5, 0.5, 0}, 0.3);
  EXPECT_TRUE(!crease.at_patch_border && crease.at_crease && !crease.at_border);
  EXPECT_TRUE(diagnose(s, {5.1, 0.9, 0}, 0.3).at_border);
  // where they meet at an angle, patches cannot be merged
  for (Vec3& p : s.points) p.z = std::max(0.0, p.x - 5);
  EXPECT_FALSE(diagnose(s, {5, 0.5, 0}, 0.3).at_patch_border);
}
