// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/sheet_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "lib/core/error.h"
#include "lib/core/topology.h"
#include "lib/shape/shape.h"
#include "lib/size/layers.h"

using namespace meshpipe;

namespace {

constexpr double none = 100;

std::vector<double> radii(const Mesh& m, SheetDistance::Side side) {
  const std::vector<int> opposite = opposite_halfedges(m.tris, (int)m.points.size());
  return SheetDistance({m, opposite}, side, none).radii();
}

/// Largest and median relative error at the vertices; truth 0: not looked at.
struct Errors {
  double largest = 0, median = 0;
};
Errors errors(const Mesh& m, const std::vector<double>& r, const std::function<double(Vec3)>& truth) {
  std::vector<double> all{0};
  for (std::size_t v = 0; v < r.size(); ++v)
    if (const double t = truth(m.points[v]); t > 0) all.push_back(std::abs(r[v] / t - 1));
  std::sort(all.begin(), all.end());
  return {all.back(), all[all.size() / 2]};
}

Mesh join(Mesh a, const Mesh& b, bool invert) {
  const int first = (int)a.points.size();
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (Tri t : b.tris) {
    if (invert) std::swap(t[1], t[2]);
    a.tris.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return a;
}

Mesh scaled(Mesh m, double s) {
  for (Vec3& p : m.points) p = s * p;
  return m;
}

}  // namespace

TEST(sheet_distance, RadiusOfTubesIsRightEverywhere) {
  for (bool closed : {false, true})
    for (int around : {12, 40, 100}) {
      const Mesh m = tube(5, around, closed);
      const auto r = radii(m, SheetDistance::inside);
      // next to the caps these are nearer than the other side
      const auto e = errors(m, r, [&](Vec3 p) { return closed && (p.z < 0.01 || p.z > 4.99) ? 0.0 : 0.5; });
      EXPECT_LT(e.largest, 0.05) << around;
    }
}

TEST(sheet_distance, RadiusOfConesAndToriIsRightEverywhere) {
  Mesh cone = tube(6, 60, false);
  for (Vec3& p : cone.points) p = {(1 - 0.1 * p.z) * p.x, (1 - 0.1 * p.z) * p.y, p.z};
  EXPECT_LT(errors(cone, radii(cone, SheetDistance::inside), [](Vec3 p) { return 0.5 - 0.05 * p.z; }).largest,
            0.05);
  for (double r : {0.1, 0.3, 0.5}) {
    const Mesh m = torus(r, 20000);
    EXPECT_LT(errors(m, radii(m, SheetDistance::inside), [&](Vec3) { return r; }).largest, 0.05) << r;
  }
  const Mesh ball = sphere(5000);
  EXPECT_LT(errors(ball, radii(ball, SheetDistance::inside), [](Vec3) { return 1.0; }).largest, 0.01);
  for (double r : radii(ball, SheetDistance::outside)) EXPECT_EQ(r, none);
}

TEST(sheet_distance, NoiseHardlyMatters) {
  for (double noise : {0.1, 0.2, 0.3}) {
    Mesh m = tube(5, 50, false);
    add_noise(m, noise, 1);
    const auto e = errors(m, radii(m, SheetDistance::inside), [](Vec3) { return 0.5; });
    EXPECT_LT(e.largest, 0.1) << noise;
    EXPECT_LT(e.median, 0.03) << noise;
  }
}

TEST(sheet_distance, BetweenShellsAndPlatesItIsHalfTheirDistance) {
  const Mesh shells = join(sphere(20000), scaled(sphere(15000), 0.9), true);  // a hollow ball
  EXPECT_LT(errors(shells, radii(shells, SheetDistance::inside), [](Vec3) { return 0.05; }).largest, 0.05);
  const Mesh nested =
      join(join(sphere(20000), scaled(sphere(20000), 1.3), true), scaled(sphere(20000), 2), false);
  const auto gap = radii(nested, SheetDistance::outside);
  EXPECT_LT(errors(nested, gap, [](Vec3 p) { return norm(p) < 1.5 ? 0.15 : 0.0; }).largest, 0.05);
  Mesh plate = cube(20000);
  for (Vec3& p : plate.points) p.z *= 0.05;
  const auto half = radii(plate, SheetDistance::inside);
  auto inner = [](double x) { return x > 0.001 && x < 0.999; };
  EXPECT_LT(errors(plate, half, [&](Vec3 p) { return inner(p.x) && inner(p.y) ? 0.025 : 0; }).largest, 0.05);
}

TEST(sheet_distance, RadiusOfTubesAlsoWhereTheyMeet) {
  struct Branch {
    Vec3 to;
    double radius;
  };
  struct Junction {
    std::vector<Branch> branches;
    double blend;
  };
  for (const Junction& junction :
       {Junction{{{{0, 0, -4}, 0.5}, {{1.6, 0.3, 4}, 0.42}, {{-2, -0.3, 3.5}, 0.4}}, 0.2},
        {{{{0, 0, -4}, 0.5}, {{1.6, 0.3, 4}, 0.42}, {{-2, -0.3, 3.5}, 0.4}}, 1e-9},
        {{{{0, 0, -4}, 0.5}, {{0, 0, 4}, 0.5}, {{4, 0, 0}, 0.5}}, 0.2},
        {{{{0, 0, -4}, 0.5}, {{0, 0, 4}, 0.5}, {{4, 0, 0}, 0.25}}, 0.1},
        {{{{0, 0, -4}, 0.5}, {{0, 0, 4}, 0.5}, {{2.5, 0, 2.5}, 0.2}}, 0.05},
        {{{{0, 0, -4}, 0.5}, {{2, 0, 4}, 0.35}, {{-1, 1.7, 4}, 0.35}, {{-1, -1.7, 4}, 0.35}}, 0.2}}) {
    auto distance = [](const Branch& b, Vec3 p) {
      return norm(p - std::clamp(dot(p, b.to) / dot(b.to, b.to), 0.0, 1.0) * b.to) - b.radius;
    };
    auto f = [&](Vec3 p) {
      double d = 1e9;
      for (const Branch& b : junction.branches) {  // as unions of a tree are, blended
        const double e = distance(b, p), h = std::max(junction.blend - std::abs(d - e), 0.0);
        d = std::min(d, e) - h * h / (4 * junction.blend);
      }
      return d;
    };
    Mesh m = march(f, {-5, -5, -5}, {5, 5, 5}, 90);
    relax_on(m, f, 5);
    const auto r = radii(m, SheetDistance::inside);
    double least = 0, most = 0, off = 0;
    for (std::size_t v = 0; v < r.size(); ++v) {
      // of the branches that are near the largest and the smallest count; away from round ends
      double lo = 1e9, hi = 0;
      int near = 0;
      bool end = false;
      for (const Branch& b : junction.branches) {
        const double length = norm(b.to), d = distance(b, m.points[v]);
        end |= dot(m.points[v], b.to) / length > length - 1.2 * b.radius && d < 0.5 * b.radius;
        if (d > 0.5 * b.radius + junction.blend) continue;
        ++near;
        lo = std::min(lo, b.radius), hi = std::max(hi, b.radius);
      }
      if (end) continue;
      const double error = r[v] < lo ? r[v] / lo - 1 : r[v] > hi ? r[v] / hi - 1 : 0;
      least = std::min(least, error), most = std::max(most, error);
      if (near == 1) off = std::max(off, std::abs(error));
    }
    EXPECT_GT(least, -0.1);
    EXPECT_LT(most, 0.1);
    EXPECT_LT(off, 0.05);
  }
}

//    Tubes of a few sides, as thin branches of coarse trees are: no fold is their radius, no opening
//    their end. The branches' radii are 0.095 to 0.5; the circle in a triangle has half of that around it.
TEST(sheet_distance, RadiusOfCoarseTubesIsThatOfASection) {
  for (int around : {4, 5, 6, 8}) {
    const Mesh m = tube(5, around, false);
    for (double r : radii(m, SheetDistance::inside)) {
      EXPECT_GT(r, 0.69 * 0.5) << around;
      EXPECT_LT(r, 1.05 * 0.5) << around;
    }
  }
  for (int outlets : {60, 147}) {
    const Mesh m = branching_tree(0, outlets, 0.8, 25000, 1);
    std::vector<double> r = radii(m, SheetDistance::inside);
    std::sort(r.begin(), r.end());
    EXPECT_GT(r[0], 0.45 * 0.095) << outlets;
    EXPECT_GT(r[r.size() / 50], 0.6 * 0.095) << outlets;
    EXPECT_LT(r.back(), 1.1 * 0.5) << outlets;
  }
}

//    A roof of 40 degrees over a floor, ten long: its edges are folds, not thin places.
// n sides, rings of edges as long as these; all corners of the section are sharp
Mesh prism(int sides) {
  Mesh m;
  const int rings = 12;
  for (int k = 0; k <= rings; ++k)
    for (int i = 0; i < sides; ++i) {
      const double a = 2 * M_PI * i / sides;
      m.points.push_back({std::cos(a), std::sin(a), 0.5 * k});
    }
  for (int k = 0; k < rings; ++k)
    for (int i = 0; i < sides; ++i) {
      const int a = k * sides + i, b = k * sides + (i + 1) % sides;
      m.tris.push_back({a, b, b + sides});
      m.tris.push_back({a, b + sides, a + sides});
    }
  return m;
}

TEST(sheet_distance, RadiusOfTubesOfFewSides) {
  for (int sides : {3, 4, 6}) {
    const Mesh m = prism(sides);
    const double inner = std::cos(M_PI / sides);  // radii of the circles within and around
    for (double r : radii(m, SheetDistance::inside)) {
      EXPECT_GT(r, 0.9 * inner) << sides;
      EXPECT_LT(r, 1.05) << sides;
    }
  }
}

TEST(sheet_distance, FoldsAreNotThin) {
  Mesh m = tube(10, 100, true);
  for (Vec3& p : m.points) p.x *= 0.1 + 0.9 * std::abs(p.y);  // pinched along y = 0, sharp at y = 1 / 2
  for (double r : radii(m, SheetDistance::inside)) EXPECT_GT(r, 0.02);
}

TEST(sheet_distance, OpenSurfacesMayBeInsideOut) {
  Mesh m = tube(5, 40, false);
  const auto before = radii(m, SheetDistance::inside);
  for (Tri& t : m.tris) std::swap(t[1], t[2]);
  EXPECT_EQ(radii(m, SheetDistance::inside).size(), before.size());
  for (double r : radii(m, SheetDistance::inside)) EXPECT_NEAR(r, 0.5, 0.025);
  for (double r : radii(m, SheetDistance::outside)) EXPECT_EQ(r, none);
}

TEST(sheet_distance, PointsOfASplitSurfaceAreMeasuredToo) {
  Mesh plate = cube(12);  // two triangles a side
  for (Vec3& p : plate.points) p.z *= 0.02;
  const std::vector<int> opposite = opposite_halfedges(plate.tris, (int)plate.points.size());
  const SheetDistance sheets({plate, opposite}, SheetDistance::inside, none);
  EXPECT_NEAR(sheets.radius_at({0.4, 0.3, 0.02}), 0.01, 1e-4);
  EXPECT_NEAR(sheets.radius_at({0.4, 0.3, 0}), 0.01, 1e-4);
}

TEST(layers, FitWhereThereIsSpace) {
  const Layers thin = parse_layers("0.02,1.5,4"), thick = parse_layers("0.06,1.5,4");
  EXPECT_NEAR(thin.total(), 0.02 * (1 + 1.5 + 2.25 + 3.375), 1e-12);
  Surface s = surface_of(torus(0.3, 20000));
  EXPECT_EQ(check_layers(s, thin).all, 0);
  const LayerReport r = check_layers(s, thick);  // 0.49 in a tube of radius 0.3
  EXPECT_EQ(r.all, (int)s.points.size());
  EXPECT_NEAR(r.least, 0.3, 0.02);
  EXPECT_TRUE(s.vertex.has("layers"));
  Layers out = thick;
  out.outside = true;  // the hole is 1.4 wide; it bends away, except along the ring
  EXPECT_EQ(check_layers(s, out).all, 0);
}

TEST(layers, CornersLeaveNone) {
  Surface s;  // a prism with an edge of 20 degrees
  const double y = std::tan(10 * 3.14159265358979 / 180);
  s.points = {{0, 0, 0}, {1, y, 0}, {1, -y, 0}, {0, 0, 1}, {1, y, 1}, {1, -y, 1}};
  s.tris = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {0, 2, 5}, {0, 5, 3}, {1, 4, 5}, {1, 5, 2}};
  s = surface_of(s);
  const LayerReport r = check_layers(s, parse_layers("0.01"));
  EXPECT_EQ(r.cause, LayerReport::corner);
  EXPECT_NEAR(r.measured, 20, 1e-6);
  EXPECT_EQ(r.vertices[LayerReport::corner], 2);
}

TEST(layers, RefusesWhatIsNoLayers) {
  for (const char* text : {"", "0", "-1", "x", "1,", "1,0", "1,1.2,0", "1,1.2,2.5", "1,1.2,3,4",
                           "1,1e300,1000", "outside", "1,,outside", "inf", "nan"})
    EXPECT_THROW(parse_layers(text), BadUsage) << text;
  EXPECT_TRUE(parse_layers("1,outside").outside);
}
