// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/topology.h"
#include "lib/lift/lift.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

namespace {

/// Two tori, one within the other, between which the body is.
Surface shell(double wall, int n) {
  Mesh mesh = torus(0.4, n), inner = torus(0.4 - wall, n);
  const int first = (int)mesh.points.size();
  mesh.points.insert(mesh.points.end(), inner.points.begin(), inner.points.end());
  for (const Tri& t : inner.tris) mesh.tris.push_back({first + t[0], first + t[2], first + t[1]});
  return surface_of(std::move(mesh));
}

}  // namespace

TEST(CoarseSurface, KeepsThinWallsApart) {
  std::string reason;
  Surface thick = shell(0.2, 40000), thin = shell(0.004, 40000);
  const std::optional<Surface> coarse = coarse_surface(thick, 0.1, false, reason);
  ASSERT_TRUE(coarse);
  EXPECT_LT(coarse->tris.size(), 20000u);
  EXPECT_TRUE(self_intersections(*coarse).empty());
  EXPECT_EQ(topology_of(*coarse).components, 2);
  const std::optional<Surface> walls = coarse_surface(thin, 0.1, false, reason);
  if (walls) {  // with fewer triangles they would be off by more than the wall
    EXPECT_TRUE(self_intersections(*walls).empty());
    EXPECT_GT(walls->tris.size(), 30000u);
  }
}

TEST(CoarseSurface, LeavesWhatIntersectsItself) {
  Surface s = shell(0, 40000);
  for (int v = 0; v < (int)s.points.size() / 2; ++v) s.points[v].x += 0.3;
  std::string reason;
  EXPECT_FALSE(coarse_surface(s, 0.1, false, reason));
  EXPECT_NE(reason.find("intersects itself"), std::string::npos);
}

TEST(CoarseSurface, ContractsAlongLongTriangles) {
  // an open cylinder of 20 sides, of which each has 2000 rows of two triangles: 0.3 long, 0.01 high
  Surface s;
  for (int j = 0; j <= 2000; ++j)
    for (int i = 0; i < 20; ++i)
      s.points.push_back({std::cos(i * 18 * degree), std::sin(i * 18 * degree), 0.01 * j});
  for (int j = 0; j < 2000; ++j)
    for (int i = 0; i < 20; ++i) {
      const int a = 20 * j + i, b = 20 * j + (i + 1) % 20;
      s.tris.push_back({a, b, b + 20}), s.tris.push_back({a, b + 20, a + 20});
    }
  s = surface_of(std::move(s));
  std::string reason;
  const std::optional<Surface> coarse = coarse_surface(s, 0.2, false, reason);
  ASSERT_TRUE(coarse);
  EXPECT_LT(coarse->tris.size(), 8000u);
  EXPECT_NEAR(total_area(*coarse), total_area(s), 1e-3 * total_area(s));
  EXPECT_EQ(topology_of(*coarse).loops, 2);
  std::size_t border = 0;
  for (int h : opposite_halfedges(*coarse)) border += h < 0;
  EXPECT_EQ(border, 40u);
}

TEST(CoarseSurface, RefusesPinchedVertices) {
  Surface s =
      surface_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}});
  std::string reason;
  EXPECT_THROW(coarse_surface(s, 0.1, false, reason), NotAdmissible);
}

TEST(CoarseSurface, LeavesOutVerticesWithoutTriangles) {
  Mesh mesh = torus(0.4, 40000);
  mesh.points.insert(mesh.points.begin(), {5, 5, 5});
  for (Tri& t : mesh.tris)
    for (int& v : t) ++v;
  Surface s = surface_of(std::move(mesh));
  std::string reason;
  const std::optional<Surface> coarse = coarse_surface(s, 0.1, false, reason);
  ASSERT_TRUE(coarse);
  for (Vec3 p : coarse->points) EXPECT_LT(p.x, 2);
}
