// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "lib/clean/clean.h"
#include "lib/core/topology.h"
#include "tests/unit/squares.h"

using namespace meshpipe;

namespace {

/// Adds n by n unit squares.
void add(Mesh& to, int squares, Vec3 corner, bool reversed = false) {
  Mesh m = unit_squares(squares);
  for (Vec3& p : m.points) p = p + corner;
  const int n = (int)to.points.size();
  for (const auto& [a, b, c] : m.tris)
    to.tris.push_back(reversed ? Tri{n + a, n + c, n + b} : Tri{n + a, n + b, n + c});
  to.points.insert(to.points.end(), m.points.begin(), m.points.end());
}

/// Each triangle on points of its own, which are off by at most `error` in each coordinate.
Surface soup(const Mesh& mesh, double error) {
  std::mt19937 random(1);
  Mesh m;
  auto off = [&] { return error * (2 * (random() / 4294967295.0) - 1); };
  for (const Tri& t : mesh.tris) {
    const int n = (int)m.points.size();
    for (int v : t) m.points.push_back(mesh.points[v] + Vec3{off(), off(), off()});
    m.tris.push_back({n, n + 1, n + 2});
  }
  return surface_of(std::move(m));
}

int loops(const Surface& s) { return topology_of(s).loops; }

/// A double cone around the z axis whose ends are `columns` points at this distance from the axis.
Surface double_cone(int columns, double radius) {
  Mesh m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < columns; ++j) {
      const double phi = 2 * std::numbers::pi * j / columns, r = i == 1 ? 1 : radius;
      m.points.push_back({r * std::cos(phi), r * std::sin(phi), i - 1.0});
    }
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < columns; ++j) {
      const int a = columns * i + j, d = columns * i + (j + 1) % columns;
      m.tris.push_back({a, d, d + columns});
      m.tris.push_back({a, d + columns, a + columns});
    }
  return surface_of(std::move(m));
}

}  // namespace

TEST(Seams, ASoupWhosePointsAreOffIsWelded) {
  for (double error : {1e-11, 1e-7, 1e-4}) {
    Surface s = soup(unit_squares(10), error);
    const CleanReport r = clean(s);
    EXPECT_EQ(r.components, 1) << error;
    EXPECT_EQ(s.points.size(), 121u);
    EXPECT_EQ(r.welded_near, 600 - 121);
    EXPECT_EQ(loops(s), 1);
    EXPECT_GT(r.tolerance, error);
    EXPECT_LT(r.tolerance, 4 * error);
    EXPECT_EQ(find_gaps(s, r).closed, 0);
    EXPECT_TRUE(clean(s).nothing);
  }
}

TEST(Seams, BordersOfPatchesThatAlmostFitAreWelded) {
  Mesh m = unit_squares(10);
  add(m, 10, {10 + 1e-5, 0, 0});
  Surface s = surface_of(m);
  EXPECT_EQ(clean(s).welded_near, 11);
  EXPECT_EQ(loops(s), 1);
  m = unit_squares(10);
  add(m, 10, {10.01, 0, 0});  // too far for an error
  s = surface_of(m);
  EXPECT_TRUE(clean(s).nothing);
}

TEST(Seams, SheetsThatLieOnEachOtherStayApart) {
  for (bool reversed : {false, true})
    for (double distance : {1e-8, 1e-5}) {
      Mesh m = unit_squares(10);
      add(m, 10, {0, 0, distance}, reversed);
      Surface s = surface_of(m);
      EXPECT_TRUE(clean(s).nothing) << distance;
    }
}

//          4     5      the points 0 to 3 are in line, with two triangles of no area between them; flips
//         /|   / |      along the slit do not end, and leave the surface as it was
//        0-1--2--3
//         \   | /
//            6
TEST(Seams, TheBorderIsThatOfTheSurfaceThatStays) {
  Surface s =
      surface_of({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 1, 0}, {3, 1, 0.5}, {2, -1, 0.3}},
                  {{0, 3, 2}, {3, 0, 1}, {0, 2, 4}, {2, 3, 5}, {2, 5, 6}, {2, 6, 4}, {3, 1, 6}, {6, 1, 4}}});
  const CleanReport r = clean(s);
  EXPECT_TRUE(r.nothing);
  EXPECT_EQ(r.flat, 2);
  std::vector<int> border;
  const std::vector<int> opposite = opposite_halfedges(s);
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] < 0) border.push_back(h);
  EXPECT_EQ(r.sheets.border, border);
}

TEST(Seams, LargeErrorsAreReportedWithWhatWeldsThem) {
  Surface s = soup(unit_squares(10), 1e-2);
  CleanReport r = clean(s);
  EXPECT_EQ(r.components, 200);
  const Gaps gaps = find_gaps(s, r);
  EXPECT_EQ(gaps.closed, 560);
  EXPECT_EQ(gaps.edges, 600);
  EXPECT_EQ(gaps_of({"spikes 1", "gaps " + gaps.text()}).within, gaps.within);
  r = clean(s, {.weld = gaps.within});
  EXPECT_EQ(r.components, 1);
  EXPECT_EQ(s.points.size(), 121u);
  EXPECT_EQ(find_gaps(s, r).closed, 0);
}

TEST(Clusters, PointsFarBelowAllEdgesAreOne) {
  for (double radius : {1e-12, 1e-9}) {
    Surface s = double_cone(24, radius);
    const CleanReport r = clean(s);
    EXPECT_EQ(r.welded_near, 46) << radius;
    EXPECT_NEAR(r.tolerance, 2 * radius, 1e-2 * radius);
    EXPECT_EQ(loops(s), 0);
    EXPECT_TRUE(clean(s).nothing);
  }
  Surface s = double_cone(24, 1e-5);  // holes
  EXPECT_TRUE(clean(s).nothing);
}

TEST(Clusters, ANeckStays) {
  // two cones whose ends are joined by a ring of 4e-7
  constexpr int n = 12;
  Mesh m{{{0, 0, -1}, {0, 0, 1}}, {}};
  for (auto [r, z] : {std::pair{1.0, -1.0}, {4e-7, 0.0}, {1.0, 1.0}})
    for (int i = 0; i < n; ++i) m.points.push_back({r * std::cos(i / 1.91), r * std::sin(i / 1.91), z});
  for (int i = 0; i < n; ++i) {
    const int a = 2 + i, b = 2 + (i + 1) % n;
    m.tris.insert(m.tris.end(), {{0, b, a}, {a, b, b + n}, {a, b + n, a + n}});
    m.tris.insert(m.tris.end(), {{a + n, b + n, b + 2 * n}, {a + n, b + 2 * n, a + 2 * n}});
    m.tris.push_back({1, a + 2 * n, b + 2 * n});
  }
  Surface s = surface_of(m);
  EXPECT_EQ(clean(s).welded_near, 0);
}

TEST(Clusters, ThinPartsStay) {
  // a needle from a base of 1e-8, a plate as thin, and a point so far away that all others are near
  const std::vector<Tri> tetra{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  Surface needle = surface_of({{{0, 0, 0}, {1e-8, 0, 0}, {0, 1e-8, 0}, {0, 0, 1}}, tetra});
  EXPECT_EQ(clean(needle).welded_near, 0);
  Mesh plate = unit_squares(1);
  add(plate, 1, {0, 0, 1e-8}, true);
  for (auto [a, b] : {std::pair{0, 1}, {1, 3}, {3, 2}, {2, 0}}) {
    plate.tris.push_back({a, b + 4, b});
    plate.tris.push_back({a, a + 4, b + 4});
  }
  Surface closed = surface_of(plate);
  EXPECT_EQ(loops(closed), 0);
  EXPECT_EQ(clean(closed).welded_near, 0);
  Surface far = surface_of(unit_squares(10));
  far.points[60].z = 1e9 + 0.1;  // not in single precision, whose noise would be 100
  EXPECT_EQ(clean(far).welded_near, 0);
}
