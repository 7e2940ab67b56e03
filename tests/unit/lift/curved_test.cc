// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lib/core/cut.h"
#include "lib/feature/feature.h"
#include "lib/lift/lift.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

namespace {

/// Places in a triangle, corners and middles of edges among them.
const std::vector<std::array<double, 3>> places = {{1, 0, 0},      {0, 1, 0},     {0.5, 0.5, 0},
                                                   {0, 0.5, 0.5},  {0.2, 0, 0.8}, {1. / 3, 1. / 3, 1. / 3},
                                                   {0.6, 0.2, 0.2}};

Vec3 flat_point(const Mesh& m, const Place& p) {
  const Tri& t = m.tris[p.face];
  return p.b0 * m.points[t[0]] + p.b1 * m.points[t[1]] + p.b2 * m.points[t[2]];
}

/// The largest error of the flat and the smooth surface where `counts` holds.
std::array<double, 2> errors(
    const Surface& s, const std::function<double(Vec3)>& error,
    const std::function<bool(Vec3)>& counts = [](Vec3) { return true; }) {
  const CurvedSurface smooth(s);
  std::array<double, 2> most{0, 0};
  for (int t = 0; t < (int)s.tris.size(); ++t)
    for (const auto& b : places) {
      const Place place{t, b[0], b[1], b[2]};
      const Vec3 p = flat_point(s, place);
      if (!counts(p)) continue;
      most[0] = std::max(most[0], std::abs(error(p)));
      most[1] = std::max(most[1], std::abs(error(smooth.point(place))));
    }
  return most;
}

TEST(CurvedSurface, SphereIsRound) {
  const auto [flat, smooth] = errors(surface_of(sphere(500)), [](Vec3 p) { return norm(p) - 1; });
  EXPECT_GT(flat, 0.01);
  EXPECT_LT(smooth, flat / 100);
}

TEST(CurvedSurface, TubeIsRoundUpToItsRims) {
  for (bool closed : {false, true}) {
    Surface s = surface_of(tube(3, 16, closed));
    mark_features(s, {});
    const auto [flat, smooth] = errors(
        s, [](Vec3 p) { return std::hypot(p.x, p.y) - 0.5; },
        [&](Vec3 p) { return std::hypot(p.x, p.y) > 0.48; });
    EXPECT_GT(flat, 0.009);
    EXPECT_LT(smooth, flat / 15);
  }
}

TEST(CurvedSurface, PlanesAndStraightEdgesStay) {
  Surface s = surface_of(cube(200));
  mark_features(s, {});
  const CurvedSurface smooth(s);
  for (int t = 0; t < (int)s.tris.size(); ++t)
    for (const auto& b : places) {
      const Place place{t, b[0], b[1], b[2]};
      EXPECT_LT(norm(smooth.point(place) - flat_point(s, place)), 1e-15);
    }
}

//  a plate whose long edges are rounded off by narrow strips: the plate stays plane
TEST(CurvedSurface, FlatFaceNextToFilletStays) {
  Surface s;
  const double a[] = {-90, -75, -60, -45, -30, -15, 0};
  for (double y : {0., 4.}) {
    for (double x : a)
      s.points.push_back({0.1 * std::sin(x * M_PI / 180), y, 0.1 * std::cos(x * M_PI / 180)});
    for (int i = 6; i >= 0; --i)
      s.points.push_back({3 - 0.1 * std::sin(a[i] * M_PI / 180), y, 0.1 * std::cos(a[i] * M_PI / 180)});
  }
  for (int i = 0; i < 13; ++i) {
    s.tris.push_back({i, i + 1, i + 15});
    s.tris.push_back({i, i + 15, i + 14});
  }
  s.vertex.rows = s.points.size();
  s.face.rows = s.tris.size();
  const CurvedSurface smooth(s);
  for (int t : {12, 13})
    for (const auto& b : places) EXPECT_NEAR(smooth.point({t, b[0], b[1], b[2]}).z, 0.1, 1e-12);
  const Vec3 on_strip = smooth.point({0, 0, 0.5, 0.5});
  EXPECT_NEAR(std::hypot(on_strip.x, on_strip.z), 0.1, 1e-4);
}

TEST(CurvedSurface, CutsLeaveNoTrace) {
  const Surface whole = surface_of(sphere(300));
  Surface cut = whole;
  std::vector<int> origin(cut.tris.size());
  for (std::size_t t = 0; t < origin.size(); ++t) origin[t] = (int)t;
  cut.face.set("origin", origin);
  std::vector<double> field;
  for (Vec3 p : cut.points) field.push_back(p.x + 0.3 * p.y - 0.17);
  std::vector<int> side;
  EXPECT_GT(cut_by_scalar_field(cut, field, {}, side), 20);
  const CurvedSurface smooth(cut);
  double most = 0;
  for (int t = 0; t < (int)cut.tris.size(); ++t)
    for (const auto& b : places)
      most = std::max(most, std::abs(norm(smooth.point({t, b[0], b[1], b[2]})) - 1));
  EXPECT_LT(most, 3e-4);  // the flat pieces are 0.018 off
}

TEST(CurvedSurface, NoiseIsBounded) {
  Mesh m = sphere(500);
  add_noise(m, 0.5, 1);
  const Surface s = surface_of(m);
  const CurvedSurface smooth(s);
  for (int t = 0; t < (int)s.tris.size(); ++t) {
    double longest = 0;
    for (int i = 0; i < 3; ++i)
      longest = std::max(longest, norm(s.points[s.tris[t][i]] - s.points[s.tris[t][(i + 1) % 3]]));
    for (const auto& b : places) {
      const Place place{t, b[0], b[1], b[2]};
      EXPECT_LE(norm(smooth.point(place) - flat_point(s, place)), 0.2 * longest);
    }
  }
}

/// A mesh with the reference's own vertices and triangles.
LiftedMesh mesh_on(const Surface& s) {
  LiftedMesh mesh;
  static_cast<Mesh&>(mesh) = s;
  mesh.place.resize(s.points.size());
  for (int t = 0; t < (int)s.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      mesh.place[s.tris[t][i]] = {t, i == 0 ? 1. : 0., i == 1 ? 1. : 0., i == 2 ? 1. : 0.};
  mesh.kind.assign(s.points.size(), 0);
  mesh.model.assign(s.tris.size(), 0);
  if (s.face.has("model")) mesh.model = s.face.get<std::uint8_t>("model");
  return mesh;
}

TEST(CurvedSurface, MidPointsLieOnTheSurface) {
  const Surface s = surface_of(sphere(500));
  const CurvedSurface smooth(s);
  const LiftedMesh mesh = mesh_on(s);
  const MidPoints flat = mid_points(mesh, s, nullptr), round = mid_points(mesh, s, &smooth);
  ASSERT_EQ(flat.points.size(), s.tris.size() * 3 / 2);
  ASSERT_EQ(round.points.size(), flat.points.size());
  EXPECT_EQ(round.straight, 0);
  for (std::size_t i = 0; i < flat.points.size(); ++i) {
    const MidPoint& p = flat.points[i];
    EXPECT_LT(p.a, p.b);
    EXPECT_LT(norm(p.point - lerp(s.points[p.a], s.points[p.b], 0.5)), 1e-12);
    EXPECT_NEAR(norm(round.points[i].point), 1, 1e-4);
  }
}

TEST(CurvedSurface, MidPointsOfModelEdgesLieOnThem) {
  Surface s = surface_of(tube(1, 12, true));
  mark_features(s, {});
  LiftedMesh mesh = mesh_on(s);
  const MidPoints middle = mid_points(mesh, s, nullptr);
  for (const MidPoint& p : middle.points)
    EXPECT_LT(norm(p.point - lerp(s.points[p.a], s.points[p.b], 0.5)), 1e-12);
  const CurvedSurface smooth(s);
  const auto& model = s.face.get<std::uint8_t>("model");
  int rim = 0;
  for (const MidPoint& p : mid_points(mesh, s, &smooth).points)
    for (int h = 0; h < 3 * (int)s.tris.size(); ++h)
      if (origin(s.tris, h) == p.a && target(s.tris, h) == p.b && (model[h / 3] >> h % 3 & 1)) {
        ++rim;
        EXPECT_NEAR(std::hypot(p.point.x, p.point.y), 0.5, 1e-3);
      }
  EXPECT_EQ(rim, 24);
}

//  A vertex on a tall spike of the reference: triangles of second order around it would fold.
//
//      3-------2        4 is above the middle, the mesh has the square's two
//      | \ 4 / |        triangles only, its diagonal's middle lies on the
//      |  / \  |        slope of the spike next to it
//      0-------1
TEST(CurvedSurface, FoldedTrianglesAreStraight) {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.95, 0.05, 3}};
  s.tris = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  s.vertex.rows = 5, s.face.rows = 4;
  LiftedMesh mesh = mesh_on(s);
  mesh.points.pop_back(), mesh.place.pop_back(), mesh.kind.pop_back();
  mesh.tris = {{0, 1, 2}, {0, 2, 3}};
  mesh.model = {0, 0};
  const MidPoints middle = mid_points(mesh, s, nullptr);
  ASSERT_EQ(middle.points.size(), 5u);
  EXPECT_GT(middle.straight, 0);
  EXPECT_EQ(norm(middle.points[1].point - Vec3{0.5, 0.5, 0}), 0);  // of edge 0, 2
}

}  // namespace
