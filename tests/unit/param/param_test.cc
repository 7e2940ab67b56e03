// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/param.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "lib/core/error.h"
#include "lib/param/intrinsic.h"
#include "tests/unit/grid.h"

using namespace meshpipe;
using std::numbers::pi;

/// The map asked for, or none.
static std::vector<Vec2> plain_map(const SubMesh& part, ParamOptions options) {
  ParamReport report;
  options.strict = true;
  return map_part(part, options, report);
}
static std::vector<Vec2> conformal_map(const SubMesh& m) { return plain_map(m, {}); }
static std::vector<Vec2> convex_map(const SubMesh& m) { return plain_map(m, {.map = MapKind::convex}); }

TEST(Param, AFlatPlateWithHolesIsMappedByARigidMotion) {
  // an L with a round-the-corner hole that no circle resembles, tilted in space, in units of 1e-7
  auto plate = grid(
      24, 16, false,
      [](double s, double t) {
        return Vec3{3e-7 * s, 2e-7 * t, 1e-7 * t};
      },
      [](int i, int j) {
        return !(i > 15 && j > 9) && !(i > 2 && i < 9 && j > 3 && j < 6) && !(i == 12 && j == 4);
      });
  for (ConformalForm form :
       {ConformalForm::boundary_first, ConformalForm::least_squares, ConformalForm::spectral}) {
    auto uv = plain_map(plate, {.form = form});
    EXPECT_TRUE(one_to_one(plate, uv)) << (int)form;
    auto r = distortion(plate, uv);
    EXPECT_NEAR(r.anisotropy_max, 1, 1e-6) << (int)form;
    EXPECT_NEAR(r.area_scale, 1, 1e-6) << (int)form;
  }
}

TEST(Param, ASmoothSurfaceIsMappedNearlyConformally) {
  // a cap of the sphere, 120 degrees across
  auto cap = grid(
      40, 40, false,
      [](double s, double t) {
        double x = 2 * s - 1, y = 2 * t - 1;
        double l = std::sqrt(x * x + y * y + 1);
        return Vec3{x / l, y / l, 1 / l};
      },
      all);
  auto uv = conformal_map(cap);
  EXPECT_TRUE(one_to_one(cap, uv));
  auto r = distortion(cap, uv);
  EXPECT_LT(r.anisotropy_median, 1.02);
  EXPECT_LT(r.anisotropy_p99, 1.1);
  EXPECT_LT(r.area_scale, 5);
  double area = 0;
  for (const Tri& t : cap.tris) area += 0.5 * cross(uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]]);
  EXPECT_NEAR(area, total_area(cap), 1e-12);
}

TEST(Param, TubesAreMappedToRings) {
  // eta 1.5, one border wavy; the hole shrinks by exp(-3) in length
  auto tube = grid(
      40, 24, true,
      [](double s, double t) {
        double a = -2 * pi * s;
        return Vec3{std::cos(a), std::sin(a), 3 * t + 0.2 * t * std::cos(3 * a)};
      },
      all);
  for (MapKind kind : {MapKind::conformal, MapKind::harmonic, MapKind::convex}) {
    ParamReport r;
    auto uv = map_part(tube, {.map = kind, .strict = true}, r);
    EXPECT_TRUE(one_to_one(tube, uv));
    EXPECT_EQ(r.used, kind);
    EXPECT_LT(r.anisotropy_p99, kind == MapKind::conformal ? 1.2 : 3);
  }
  for (ConformalForm form : {ConformalForm::least_squares, ConformalForm::spectral}) {
    auto uv = plain_map(tube, {.form = form});
    EXPECT_TRUE(one_to_one(tube, uv));
    EXPECT_LT(distortion(tube, uv).anisotropy_p99, 1.5);
  }
  EXPECT_TRUE(one_to_one(tube, plain_map(tube, {.form = ConformalForm::spectral, .neumann = true})));
  for (Weights weights : {Weights::mean_value, Weights::uniform})
    for (bool neumann : {false, true}) {
      ParamReport r;
      auto uv =
          map_part(tube, {.map = MapKind::convex, .weights = weights, .neumann = neumann, .strict = true}, r);
      EXPECT_TRUE(one_to_one(tube, uv));
    }
  ParamReport r;
  EXPECT_THROW(map_part(tube, {.neumann = true}, r), BadUsage);
}

TEST(Param, SliversAndDegenerateTrianglesAreMappedByTheConvexMap) {
  // columns alternately 1 and 1e-5 wide, and a row of zero height
  auto slivers = grid(
      20, 10, false,
      [](double s, double t) {
        int i = (int)std::lround(20 * s), j = (int)std::lround(10 * t);
        return Vec3{i / 2 + (i % 2) * 1e-5, j > 5 ? j - 1.0 : (double)j, std::sin(s * 3)};
      },
      all);
  ParamReport r;
  EXPECT_TRUE(one_to_one(slivers, map_part(slivers, {.map = MapKind::convex}, r)));
  EXPECT_TRUE(one_to_one(slivers, map_part(slivers, {}, r)));
}

TEST(Param, NoMapIsAllButALine) {
  // strips of triangles that are nearly flat, and bent: the repair of a few flips may leave others so flat
  // that the map is a line to rounding
  for (int seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const double flat = std::pow(10, -8 * uniform(random)), height = std::pow(10, -3 + 4 * uniform(random));
    const SubMesh part = grid(
        2 + seed % 5, 2 + seed / 5 % 4, false,
        [&](double s, double t) {
          const double e = uniform(random) < 0.3 ? flat : 1;
          const double x = s + 0.3 * e * uniform(random), y = t * e + 0.3 * e * uniform(random);
          return Vec3{x, y, height * uniform(random)};
        },
        all);
    ParamReport report;
    const auto uv = map_part(part, {}, report);
    EXPECT_TRUE(one_to_one(part, uv)) << seed;
    EXPECT_LT(report.anisotropy_mean, 100) << seed;
    EXPECT_NEAR(report.anisotropy_p99, distortion(part, uv).anisotropy_p99, 1e-9 * report.anisotropy_p99)
        << seed;
    EXPECT_TRUE(report.used == MapKind::conformal || report.bend == 0) << seed;
  }
}

//  2        one triangle, and two triangles that share no edge at 0
//  | \      .
//  0--1
TEST(Param, SmallAndWrongParts) {
  SubMesh one{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {0, 1, 2}, {0}};
  EXPECT_TRUE(one_to_one(one, conformal_map(one)));
  EXPECT_TRUE(one_to_one(one, convex_map(one)));
  SubMesh bow{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}},
              {0, 1, 2, 3, 4},
              {0, 1}};
  EXPECT_THROW(conformal_map(bow), NotAdmissible);
  SubMesh closed{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}},
                 {0, 1, 2, 3},
                 {0, 1, 2, 3}};
  EXPECT_THROW(convex_map(closed), NotAdmissible);
}

// A needle across a flat strip: the long edge of two obtuse triangles is flipped, and all weights are
// positive.
TEST(Param, IntrinsicDelaunayFlipsNeedles) {
  auto strip = grid(
      30, 4, false,
      [](double s, double t) {
        return Vec3{10 * s + 3 * t, 0.2 * t, 0};  // sheared: angles of 3 and 170 degrees
      },
      all);
  Filled before = open_holes(strip), after = intrinsic_delaunay(before);
  double area = 0;
  for (const auto& [a, b, c] : after.shape) area += 0.5 * norm(area_vector(a, b, c));
  EXPECT_NEAR(area, total_area(strip), 1e-9 * area);
  auto worst = [&](const Filled& filled) {
    // of the inner edges, by their vertices: all belong to one pair here
    std::vector<std::pair<std::array<int, 2>, double>> edges;
    auto w = cotangents(filled.shape);
    for (int h = 0; h < (int)w.size(); ++h) {
      int a = origin(filled.tris, h), b = target(filled.tris, h);
      edges.push_back({{std::min(a, b), std::max(a, b)}, w[h]});
    }
    std::sort(edges.begin(), edges.end());
    double least = 1;
    for (std::size_t e = 1; e < edges.size(); ++e)
      if (edges[e].first == edges[e - 1].first)
        least = std::min(least, edges[e].second + edges[e - 1].second);
    return least;
  };
  EXPECT_LT(worst(before), -1);
  EXPECT_GE(worst(after), -1e-9);
  auto uv = plain_map(strip, {});
  EXPECT_NEAR(distortion(strip, uv).anisotropy_max, 1, 1e-6);
}

TEST(Param, OptimizationLowersDistortionAndStaysOneToOne) {
  auto cap = grid(
      20, 20, false,
      [](double s, double t) {
        double x = 2 * s - 1, y = 2 * t - 1, l = std::sqrt(x * x + y * y + 0.3);
        return Vec3{x / l, y / l, 1 / l};
      },
      all);
  ParamReport before, after;
  auto uv = map_part(cap, {.map = MapKind::convex, .weights = Weights::uniform}, before);
  auto better = map_part(cap, {.map = MapKind::convex, .weights = Weights::uniform, .optimize = 30}, after);
  EXPECT_TRUE(one_to_one(cap, better));
  EXPECT_GT(after.steps, 1);
  EXPECT_LT(after.anisotropy_max, 0.5 * before.anisotropy_max);
  EXPECT_LT(after.area_scale, before.area_scale);
  auto flat = grid(
      8, 8, false,
      [](double s, double t) {
        return Vec3{s, 2 * t, 0};
      },
      all);
  map_part(flat, {.map = MapKind::convex, .optimize = 100}, after);
  EXPECT_LT(after.anisotropy_max, 1.1);  // the least is an isometry
  EXPECT_LT(after.area_scale, 1.1);
}
