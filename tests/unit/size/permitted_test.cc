// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/permitted.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lib/core/topology.h"
#include "lib/size/size.h"

using namespace meshpipe;

namespace {

std::vector<SizeBound> bounds_of(const Connectivity& surface, const std::vector<double>& asked,
                                 double most = 1e300) {
  std::vector<char> close;
  return permitted_sizes(surface, asked, 0, most, close);
}

std::vector<SizeBound> bounds_of(const Mesh& mesh, double asked) {
  const std::vector<int> opposite = opposite_halfedges(mesh.tris, (int)mesh.points.size());
  return bounds_of({mesh, opposite}, std::vector<double>(mesh.points.size(), asked));
}

/// A flat rectangle of two triangles.
Mesh rectangle(double length, double width) {
  return {{{0, 0, 0}, {length, 0, 0}, {length, width, 0}, {0, width, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Adds an open tube around the z axis, of triangles half as long as they are wide.
void add_tube(Mesh& mesh, double radius, double length) {
  constexpr int n = 96, rows = 20;
  const int first = (int)mesh.points.size();
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < n; ++j) {
      const double a = 2 * std::numbers::pi * j / n;
      mesh.points.push_back({radius * std::cos(a), radius * std::sin(a), length * i / rows});
    }
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = first + i * n + j, b = first + i * n + (j + 1) % n;
      mesh.tris.push_back({a, b, b + n});
      mesh.tris.push_back({a, b + n, a + n});
    }
}

/// Half an open tube along z, hollow to +y, of eight flat faces; its edge along the bottom starts at row 4.
Mesh groove(double radius, double length) {
  constexpr int n = 8;
  Mesh mesh;
  for (double z : {0.0, length})
    for (int j = 0; j <= n; ++j) {
      const double a = std::numbers::pi * (1 + (double)j / n);
      mesh.points.push_back({radius * std::cos(a), radius * std::sin(a), z});
    }
  for (int j = 0; j < n; ++j) {
    mesh.tris.push_back({j, j + 1, j + n + 2});
    mesh.tris.push_back({j, j + n + 2, j + n + 1});
  }
  return mesh;
}

}  // namespace

TEST(Permitted, SevenWidthsOfAStrip) {
  const auto bounds = bounds_of(rectangle(8, 0.2), 4);
  ASSERT_GT(bounds.size(), 4u);
  for (const SizeBound& b : bounds) {
    EXPECT_NEAR(b.size, 7 * 0.2, 1e-12);
    EXPECT_NEAR(b.gap, 0.2, 1e-12);
    EXPECT_NEAR(b.place.y, b.half_edge == 0 ? 0 : 0.2, 1e-12);
  }
  EXPECT_TRUE(bounds_of(rectangle(8, 0.2), 1.3).empty());
}

TEST(Permitted, StripsThatAskForTooMuchAreAllThatIsMeasured) {
  Mesh mesh = rectangle(8, 0.2);
  add_tube(mesh, 1, 8);
  add_tube(mesh, 1.01, 8);
  const std::vector<int> opposite = opposite_halfedges(mesh);
  auto sheets = [&](double most) {
    const auto all = bounds_of({mesh, opposite}, std::vector<double>(mesh.points.size(), 1.5), most);
    return std::count_if(all.begin(), all.end(), [](const SizeBound& x) { return x.length == 0; });
  };
  EXPECT_GT(sheets(1e300), 0);
  EXPECT_EQ(sheets(1), 0);
}

TEST(Permitted, LinesThatMeetAreNotNear) {
  EXPECT_TRUE(bounds_of(rectangle(1, 1), 100).empty());
  EXPECT_TRUE(bounds_of(rectangle(1, 0.2), 100).empty());  // five widths long
}

TEST(Permitted, LinesThatTouchWithinRoundingAreNotNear) {
  auto far_off = [](double width) {
    Mesh mesh = rectangle(8, width);
    for (Vec3& p : mesh.points) p.z = 20;  // doubles are 3.6e-15 apart there
    return mesh;
  };
  EXPECT_TRUE(bounds_of(far_off(1e-14), 4).empty());
  EXPECT_FALSE(bounds_of(far_off(1e-13), 4).empty());
}

TEST(Permitted, ChordsOfASheetStayOffTheNext) {
  Mesh mesh;
  add_tube(mesh, 1, 2);
  EXPECT_TRUE(bounds_of(mesh, 0.5).empty());
  add_tube(mesh, 0.98, 2);
  const auto bounds = bounds_of(mesh, 0.5);
  ASSERT_GT(bounds.size(), 1000u);
  for (const SizeBound& b : bounds) {
    EXPECT_NEAR(std::hypot(b.place.x, b.place.y), 1, 1e-3) << "the inner tube's chords sag away";
    EXPECT_NEAR(b.size, std::sqrt(8 * 0.3 * 0.02), 0.03);
    EXPECT_NEAR(b.gap, 0.02, 1e-3);
  }
  EXPECT_TRUE(bounds_of(mesh, 0.2).empty());
}

TEST(Permitted, EdgesAcrossAGrooveTurnByAQuarter) {
  int along = 0;
  for (const SizeBound& b : bounds_of(groove(1, 40), 4))
    if (b.length > 0 && std::abs(std::abs(b.place.x) - 1) < 1e-12) {
      EXPECT_NEAR(b.size, std::numbers::pi / 2, 2e-3);
      EXPECT_NEAR(b.gap, 2, 1e-12);
      ++along;
    }
  EXPECT_GT(along, 4);
  EXPECT_TRUE(bounds_of(groove(1, 40), 1.3).empty()) << "shorter edges follow it anyway";
}

/// A groove along z, and a ridge that ends half its radius above its bottom.
Mesh groove_with_ridge(double length) {
  Mesh mesh = groove(1, length);
  const int ridge = (int)mesh.points.size();
  for (double z : {0.0, length})
    for (Vec3 p : {Vec3{-0.1, 1.5, z}, Vec3{0, -0.5, z}, Vec3{0.1, 1.5, z}}) mesh.points.push_back(p);
  for (int i : {ridge, ridge + 1}) {
    mesh.tris.push_back({i, i + 3, i + 4});
    mesh.tris.push_back({i, i + 4, i + 1});
  }
  return mesh;
}

/// Bounds along the bottom of such a groove, between two heights.
int bounds_at_bottom(const std::vector<SizeBound>& bounds, double low, double high) {
  int n = 0;
  for (const SizeBound& b : bounds)
    if (std::abs(b.place.x) < 1e-9 && std::abs(b.place.y + 1) < 1e-9 && b.place.z > low && b.place.z < high) {
      EXPECT_NEAR(b.gap, 0.5, 1e-9);
      EXPECT_LT(b.size, 1.5);
      ++n;
    }
  return n;
}

TEST(Permitted, ChordsOfAGrooveStayOffARidgeInIt) {
  EXPECT_GT(bounds_at_bottom(bounds_of(groove_with_ridge(8), 4), 0, 8), 0);
}

TEST(Permitted, SheetsThatCrossElsewhereAreStillNear) {
  Mesh mesh = groove_with_ridge(40);
  const int crossing = (int)mesh.points.size();
  for (Vec3 p : {Vec3{0, -0.9, 1}, Vec3{0.1, -1.1, 1}, Vec3{-0.1, -1.1, 1}}) mesh.points.push_back(p);
  mesh.tris.push_back({crossing, crossing + 1, crossing + 2});
  const auto bounds = bounds_of(mesh, 4);
  EXPECT_EQ(bounds_at_bottom(bounds, 0, 4), 0);
  EXPECT_GT(bounds_at_bottom(bounds, 6, 40), 10);
}

/// An open cone around the z axis without vertices between its ends, its radius growing by `slope`.
void add_cone(Mesh& mesh, double radius, double slope, double length, int sides) {
  const int first = (int)mesh.points.size();
  for (double z : {0.0, length})
    for (int j = 0; j < sides; ++j) {
      const double a = 2 * std::numbers::pi * j / sides, r = radius + slope * z;
      mesh.points.push_back({r * std::cos(a), r * std::sin(a), z});
    }
  for (int j = 0; j < sides; ++j) {
    const int a = first + j, b = first + (j + 1) % sides;
    mesh.tris.push_back({a, b, b + sides});
    mesh.tris.push_back({a, b + sides, a + sides});
  }
}

TEST(Permitted, FourEdgesFitAroundATubeThatHasNoVerticesAlongIt) {
  Mesh mesh;
  add_cone(mesh, 0.1, 0.02, 8, 16);
  int middle = 0;
  for (const SizeBound& b : bounds_of(mesh, 1)) {
    if (b.place.z < 1 || b.place.z > 7) continue;
    EXPECT_NEAR(b.size, 0.5 * std::numbers::pi * (0.1 + 0.02 * b.place.z), 0.01) << b.place.z;
    ++middle;
  }
  EXPECT_GT(middle, 100);
  // lines along it keep its section
  std::vector<std::uint8_t> model(mesh.tris.size(), 0);
  for (int j : {0, 3, 6, 9, 12, 14}) model[2 * j + 1] = 4, model[(2 * j + 30) % 32] = 2;
  const std::vector<int> opposite = opposite_halfedges(mesh);
  const auto held = bounds_of({mesh, opposite, model}, std::vector<double>(32, 1));
  EXPECT_GT(held.size(), 0u);
  for (const SizeBound& b : held) EXPECT_GT(b.length + (b.place.z < 1) + (b.place.z > 7), 0) << b.place.z;
}

TEST(Permitted, WhatIsAskedForAndTheWidthOfNeedlesAreThoseOfThePlace) {
  // two cones, the gap between them a fiftieth of the radius: the same picture at every scale
  Mesh mesh;
  add_cone(mesh, 0.1, 0.1, 100, 96);
  const int outer = 96;
  add_cone(mesh, 0.098, 0.098, 100, 96);
  const std::vector<int> opposite = opposite_halfedges(mesh);
  std::vector<double> asked;
  for (const Vec3 p : mesh.points) asked.push_back(0.05 + 0.05 * p.z);
  int low = 0;
  for (const SizeBound& b : bounds_of({mesh, opposite}, asked)) {
    if (b.half_edge / 3 >= 2 * outer) continue;
    const double radius = 0.1 + 0.1 * b.place.z;
    EXPECT_NEAR(b.gap / radius, 0.02, 1e-3) << b.place.z;
    EXPECT_NEAR(b.size / radius, std::sqrt(8 * 0.3 * 0.02), 0.05) << b.place.z;
    low += b.place.z < 1;
  }
  EXPECT_GT(low, 96);
}

//  two half pipes, one in the other, joined along their rims
TEST(Permitted, AFoldThatLinesHoldIsNotLeftOut) {
  Mesh mesh = groove(1, 8), inner = groove(0.95, 8);
  const int n = (int)mesh.points.size(), half = n / 2, m = (int)mesh.tris.size();
  mesh.points.insert(mesh.points.end(), inner.points.begin(), inner.points.end());
  for (const auto& [a, b, c] : inner.tris) mesh.tris.push_back({n + b, n + a, n + c});
  for (int end : {0, half - 1}) {
    const int a = end, b = end + half;
    for (Tri t : {Tri{a, b, n + b}, Tri{a, n + b, n + a}})
      mesh.tris.push_back(end ? Tri{t[1], t[0], t[2]} : t);
  }
  const std::vector<int> opposite = opposite_halfedges(mesh);
  std::vector<std::uint8_t> rims(mesh.tris.size(), 0);
  for (int t = 2 * m; t < (int)mesh.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (const int o = opposite[3 * t + i]; o >= 0 && o < 6 * m)
        rims[t] |= 1 << i, rims[o / 3] |= 1 << o % 3;
  auto on_sheets = [&](const std::vector<std::uint8_t>& model) {
    const auto all = bounds_of({mesh, opposite, model}, std::vector<double>(2 * n, 3));
    return std::count_if(all.begin(), all.end(),
                         [](const SizeBound& x) { return x.gap < 0.06 && x.size < 1; });
  };
  const std::vector<std::uint8_t> none(mesh.tris.size(), 0);
  EXPECT_EQ(on_sheets(none), 0);
  EXPECT_GT(on_sheets(rims), 10);
}

TEST(Permitted, FlatSheetsAreAsNearAsTheyLike) {
  Mesh mesh = rectangle(1, 1);
  for (const Vec3 p : rectangle(1, 1).points) mesh.points.push_back(p + Vec3{0, 0, 0.001});
  mesh.tris.push_back({4, 5, 6});
  mesh.tris.push_back({4, 6, 7});
  EXPECT_TRUE(bounds_of(mesh, 0.5).empty());
}

TEST(Permitted, SizesGrowAwayFromNarrowPlaces) {
  // a strip on one side of a square: the number of triangles is met all the same
  Surface s;
  static_cast<Mesh&>(s) = rectangle(8, 0.2);
  s.points.push_back({8, 8, 0});
  s.points.push_back({0, 8, 0});
  s.tris.push_back({3, 2, 4});
  s.tris.push_back({3, 4, 5});
  s = surface_of(s);
  s.face.set("model", std::vector<std::uint8_t>{0, 2, 1, 0});
  s.face.set("part", std::vector<int>{0, 0, 0, 0});
  SizeOptions o;
  o.triangles = 40;
  const SizeReport r = set_size(s, nullptr, o);
  EXPECT_GT(r.narrow.places, 0);
  EXPECT_NEAR(r.narrow.to, 1.4, 1e-9);
  EXPECT_NEAR(r.triangles, 40, 0.5);
  const auto& size = s.vertex.get<double>("size");
  for (std::size_t v = 0; v < size.size(); ++v) EXPECT_TRUE(s.points[v].y > 0.3 || size[v] < 1.7);
  EXPECT_GT(size[4], 1.9);
}

TEST(Permitted, SmallerSizesAreBoundedWhereSheetsWereClose) {
  Mesh mesh;
  add_tube(mesh, 1, 8);
  add_tube(mesh, 1.03, 8);
  add_tube(mesh, 5, 8);
  const std::vector<int> opposite = opposite_halfedges(mesh);
  std::vector<char> close;
  permitted_sizes({mesh, opposite}, std::vector<double>(mesh.points.size(), 1.5), 0, 1e300, close);
  const auto n_close = std::count(close.begin(), close.end(), 1);
  EXPECT_GT(n_close, (long)close.size() / 5);
  EXPECT_LT(n_close, 2 * (long)close.size() / 3 + 1);
  const std::vector<double> smaller(mesh.points.size(), 0.8);
  std::vector<char> nowhere(close.size(), 0);
  EXPECT_EQ(permitted_sizes({mesh, opposite}, smaller, 0, 1e300, nowhere).size(), 0u);
  const auto all = bounds_of({mesh, opposite}, smaller);
  const auto again = permitted_sizes({mesh, opposite}, smaller, 0, 1e300, close);
  EXPECT_GT(all.size(), 100u);
  ASSERT_EQ(again.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(again[i].half_edge, all[i].half_edge);
    EXPECT_EQ(again[i].size, all[i].size);
  }
}
