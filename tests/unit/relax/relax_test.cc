// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/relax.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "lib/core/error.h"
#include "lib/core/topology.h"
#include "lib/feature/feature.h"
#include "lib/lift/lift.h"
#include "lib/shape/shape.h"
#include "tests/unit/relax/drawn.h"
#include "tests/unit/spire.h"

using namespace meshpipe;

namespace {

/// To be meshed with half as many triangles.
Surface slivered_sphere(int triangles, double share, int seed) {
  Surface s = sized(sphere(triangles), triangles / 2);
  add_slivers(s, share, seed);
  s.vertex.set("size", std::vector<double>(s.points.size(), s.vertex.get<double>("size")[0]));
  return s;
}

void expect_on_surface(const LiftedMesh& m, const Surface& s) {
  for (std::size_t v = 0; v < m.points.size(); ++v) {
    const Place& p = m.place[v];
    ASSERT_GE(p.face, 0);
    ASSERT_LT(p.face, (int)s.tris.size());
    const Tri& t = s.tris[p.face];
    const Vec3 x = p.b0 * s.points[t[0]] + p.b1 * s.points[t[1]] + p.b2 * s.points[t[2]];
    EXPECT_LT(norm(x - m.points[v]), 1e-12 * diagonal(s));
  }
}

//   4 - 3
//    \ /
//     2       two fans
//    / \.
//   0 - 1
TEST(Relax, RefusesAVertexOfTwoFans) {
  const Surface s =
      sized({{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {2, 3, 4}}}, 2);
  LiftedMesh m = lifted_of(s);
  EXPECT_THROW(relax(m, s, {}), NotAdmissible);
}

TEST(Relax, ATorusBecomesRegularAndStaysATorus) {
  const Surface s = sized(torus(0.4, 6000), 3000);
  LiftedMesh m = lifted_of(s);
  const RelaxReport r = relax(m, s, {});
  EXPECT_NEAR((double)m.tris.size(), 3000, 0.03 * 3000);
  EXPECT_TRUE(r.intersections.empty());
  EXPECT_GT(r.kappa_min, 0.7);
  EXPECT_GT(r.kappa_mean, 0.97);
  const Topology t = topology_of(m);
  EXPECT_EQ(t.genus, 1);
  EXPECT_EQ(t.loops, 0);
  EXPECT_EQ(t.components, 1);
  expect_on_surface(m, s);
}

TEST(Relax, SliversAndNoiseGo) {
  const Surface s = slivered_sphere(4000, 0.3, 1);
  LiftedMesh m = lifted_of(s);
  EXPECT_GT(relax(m, s, {}).kappa_min, 0.6);
  EXPECT_EQ(topology_of(m).genus, 0);
  expect_on_surface(m, s);
}

// around a peak of 7 degrees no triangle is good: there are four long ones, and the others are not affected
TEST(Relax, ASharpPeakGetsOneFan) {
  const Surface s = sized(spire(0.2, 60, 12), 1500);
  LiftedMesh m = lifted_of(s);
  std::vector<char> corner(s.points.size(), 0);
  corner[0] = 1;
  const RelaxReport r = relax(m, s, {}, corner);
  EXPECT_TRUE(r.intersections.empty());
  const std::size_t peak = std::find(m.points.begin(), m.points.end(), s.points[0]) - m.points.begin();
  ASSERT_LT(peak, m.points.size());
  int around = 0;
  for (const auto& [a, b, c] : m.tris) {
    const double k = kappa(m.points[a], m.points[b], m.points[c]);
    if (a != (int)peak && b != (int)peak && c != (int)peak) {
      EXPECT_GT(k, 0.3);
      continue;
    }
    ++around;
    EXPECT_GT(k, 0.02);
  }
  EXPECT_GE(around, 3);
  EXPECT_LE(around, 5);
}

TEST(Relax, TheSameInputGivesTheSameBytes) {
  const Surface s = sized(torus(0.3, 3000), 2000);
  LiftedMesh a = lifted_of(s), b = lifted_of(s);
  relax(a, s, {});
  relax(b, s, {});
  EXPECT_TRUE(a.points == b.points);
  EXPECT_TRUE(a.tris == b.tris);
}

RelaxOptions in_tiles(int triangles, double target = 0) {
  RelaxOptions options;
  options.tile = triangles;
  options.target_triangles = target;
  return options;
}

TEST(Relax, TilesLeaveNoTrace) {
  const Surface s = sized(torus(0.4, 16000), 16000);
  LiftedMesh m = lifted_of(s);
  const RelaxReport r = relax(m, s, {}, {}, in_tiles(3500, 16000));
  EXPECT_NEAR((double)m.tris.size(), 16000, 0.025 * 16000);
  EXPECT_TRUE(r.intersections.empty());
  EXPECT_GT(r.kappa_min, 0.7);
  EXPECT_GT(r.kappa_mean, 0.97);
  const Topology t = topology_of(m);
  EXPECT_EQ(t.genus, 1);
  EXPECT_EQ(t.loops, 0);
  expect_on_surface(m, s);
}

TEST(Relax, TilesGiveTheSameBytesAtAnyNumberOfThreads) {
  const Surface s = slivered_sphere(8000, 0.2, 1);
  const int threads = omp_get_max_threads();
  std::vector<LiftedMesh> results;
  for (int n : {1, 2, 5}) {
    omp_set_num_threads(n);
    relax(results.emplace_back(lifted_of(s)), s, {}, {}, in_tiles(700));
  }
  omp_set_num_threads(threads);
  for (const LiftedMesh& m : results) {
    EXPECT_TRUE(m.points == results[0].points);
    EXPECT_TRUE(m.tris == results[0].tris);
  }
}

void expect_cube_stays(const RelaxOptions& options) {
  Body body = cube(2000);
  Surface s = sized(body, 1500);
  s.face.set("patch", body.patch);
  mark_features(s, {});
  LiftedMesh m = lifted_of(s);
  // its twelve edges are lines: a vertex on two patches slides, one on three is a corner
  std::vector<std::vector<int>> patches(s.points.size());
  for (std::size_t t = 0; t < s.tris.size(); ++t)
    for (int v : s.tris[t])
      if (auto& p = patches[v]; std::find(p.begin(), p.end(), body.patch[t]) == p.end())
        p.push_back(body.patch[t]);
  for (std::size_t v = 0; v < patches.size(); ++v)
    if (patches[v].size() > 1) m.kind[v] = patches[v].size() > 2 ? 2 : 1, m.line[v] = 0;
  relax(m, s, {model_line}, {}, options);
  expect_on_surface(m, s);
  // eight corners, where they were
  int corners = 0;
  for (std::size_t v = 0; v < m.points.size(); ++v)
    if (m.kind[v] == 2) {
      ++corners;
      const Vec3 p = m.points[v];
      for (double x : {p.x, p.y, p.z}) EXPECT_TRUE(x == 0 || x == 1 || x == -0.5 || x == 0.5) << x;
    }
  EXPECT_EQ(corners, 8);
  // no triangle leaves its face of the cube: the area is exact
  EXPECT_NEAR(total_area(m), total_area(s), 1e-9);
}

TEST(Relax, ModelEdgesOfACubeStay) { expect_cube_stays({}); }

TEST(Relax, ModelEdgesOfACubeStayInTiles) { expect_cube_stays(in_tiles(400)); }

TEST(Relax, DislocationsGo) {
  const Surface s = sized(torus(0.4, 20000), 8000);
  LiftedMesh m = lifted_of(s);
  relax(m, s, {});
  std::vector<int> valence(m.points.size());
  for (const Tri& t : m.tris)
    for (int v : t) ++valence[v];  // closed: as many triangles as edges
  const auto regular = std::count(valence.begin(), valence.end(), 6);
  EXPECT_GT((double)regular, 0.85 * (double)valence.size());
  for (int v : valence) EXPECT_TRUE(v >= 5 && v <= 7) << v;
}

//        peak          A pyramid steeper than the size: smoothing alone would round its peak off.
//        /|\.
//       / | \.
//   ___/__|__\___
Surface pyramid(double triangles) {
  Mesh plate;
  const int n = 40;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = i - n / 2, y = j - n / 2, r = std::max(std::abs(x), std::abs(y));
      plate.points.push_back({x, y, std::max(0.0, 6 - r)});
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      plate.tris.push_back({a, b, d}), plate.tris.push_back({a, d, c});
    }
  return sized(plate, triangles);
}

double nearest_vertex(const LiftedMesh& m, Vec3 x) {
  double nearest = 1e300;
  for (Vec3 p : m.points) nearest = std::min(nearest, norm(p - x));
  return nearest;
}

TEST(Relax, MissedFeaturesAreReached) {
  const Surface s = pyramid(700);
  LiftedMesh m = lifted_of(s);
  relax(m, s, {});
  EXPECT_LT(nearest_vertex(m, {0, 0, 6}), 1e-9);
  expect_on_surface(m, s);
}

// A model edge runs over the peak, from left to right through the middle. With this size sliding alone would
// leave the nearest vertex a third of an edge away.
TEST(Relax, MissedFeaturesOfModelEdgesAreReachedAlongThem) {
  Surface s = pyramid(550);
  std::vector<std::uint8_t> model(s.tris.size());
  for (int t = 0; t < (int)s.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (s.points[s.tris[t][i]].y == 0 && s.points[s.tris[t][(i + 1) % 3]].y == 0) model[t] |= 1 << i;
  s.face.set("model", model);
  LiftedMesh m = lifted_of(s);
  m.model = model;
  relax(m, s, {});
  EXPECT_LT(nearest_vertex(m, {0, 0, 6}), 1e-9);
  double length = 0;
  for (int t = 0; t < (int)m.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (m.model[t] >> i & 1) {
        const Vec3 p = m.points[m.tris[t][i]], q = m.points[m.tris[t][(i + 1) % 3]];
        EXPECT_EQ(p.y, 0);
        EXPECT_EQ(q.y, 0);
        length += 0.5 * norm(q - p);
      }
  // not the kink of the peak but those at the feet are cut off, of 45 degrees, by segments of 1.2 sizes at
  // most
  const double at_a_foot = 1 / std::cos(3.14159265358979 / 8) - 1, segment = 1.2 * m.size[0];
  EXPECT_NEAR(length, 28 + 12 * std::sqrt(2.0), 2 * at_a_foot * segment);
  expect_on_surface(m, s);
}

TEST(Relax, NoTriangleIsLeftBadOnASmoothSurface) {
  const Surface s = slivered_sphere(6000, 0.25, 3);
  LiftedMesh m = lifted_of(s);
  const RelaxReport r = relax(m, s, {});
  EXPECT_GE(r.kappa_min, 0.75);
  EXPECT_GT(r.kappa_mean, 0.985);
}

TEST(Relax, CornersOfABorderStayAndItsOtherVerticesSlide) {
  Mesh square;
  const int n = 20;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) square.points.push_back({(double)i, (double)j, 0});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      square.tris.push_back({a, b, d}), square.tris.push_back({a, d, c});
    }
  const Surface s = sized(square, 500);
  std::vector<char> corner(s.points.size());
  for (int v : {0, n, n * (n + 1), (n + 1) * (n + 1) - 1}) corner[v] = 1;
  LiftedMesh m = lifted_of(s);
  relax(m, s, {}, corner);
  EXPECT_NEAR(total_area(m), n * n, 1e-9);
  EXPECT_NEAR((double)m.tris.size(), 500, 15);
}

//   .-----.   two sheets that meet at right angles in an arc, except for a millionth: an open seam. The two
//   borders
//  /  ---  \  keep the points they share, so that their chords do not cross.
TEST(Relax, OpenSeamsKeepTheirPoints) {
  Mesh sheets;
  const int n = 24;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const int first = (int)sheets.points.size();
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double x = (double)i / n, y = (double)j / n, arc = 0.5 * x * (1 - x);
        sheets.points.push_back(sheet ? Vec3{x, arc - 1e-6, -y} : Vec3{x, arc + y, 0});
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = first + j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
        if (sheet)
          sheets.tris.push_back({a, d, b}), sheets.tris.push_back({a, c, d});
        else
          sheets.tris.push_back({a, b, d}), sheets.tris.push_back({a, d, c});
      }
  }
  const Surface s = sized(sheets, 2 * n * n);
  LiftedMesh m = lifted_of(s);
  const RelaxReport r = relax(m, s, {});
  EXPECT_TRUE(r.intersections.empty());
  int found[2] = {0, 0};
  for (Vec3 p : m.points)
    for (int sheet : {0, 1})
      if (norm(p - Vec3{p.x, 0.5 * p.x * (1 - p.x) - sheet * 1e-6, 0}) < 1e-9) ++found[sheet];
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], n + 1);
}

// a plate, thinner than any triangle: what is refined in one try is missing in the next
TEST(Relax, TriesToMeetACountHaveABound) {
  Body body = cube(200);
  for (Vec3& p : body.points) p.z *= 1e-4;
  for (int target = 20; target <= 60; target += 10) {
    Surface s = sized(body, target);
    s.face.set("patch", body.patch);
    mark_features(s, {});
    LiftedMesh m = lifted_of(s);
    RelaxOptions options;
    options.target_triangles = target;
    const RelaxReport r = relax(m, s, {}, {}, options);
    EXPECT_GE(r.tries, 1);
    EXPECT_LE(r.tries, 3) << target;
    expect_on_surface(m, s);
  }
}

TEST(PlaceOn, BordersGoToBordersAndTheRestToTheSurface) {
  Mesh coarse = tube(4, 10, false), fine = tube(4, 24, false);
  ASSERT_FALSE(coarse.tris.empty());
  for (Vec3& p : coarse.points) p = 1.01 * p;
  Surface mesh, reference;
  static_cast<Mesh&>(mesh) = coarse;
  static_cast<Mesh&>(reference) = fine;
  mesh.face.rows = mesh.tris.size(), reference.face.rows = reference.tris.size();
  mesh.vertex.rows = mesh.points.size(), reference.vertex.rows = reference.points.size();
  LiftedMesh m = place_on(mesh, reference);
  expect_on_surface(m, reference);
  const auto opposite = opposite_halfedges(mesh.tris, (int)mesh.points.size());
  const auto ref_opposite = opposite_halfedges(reference.tris, (int)reference.points.size());
  for (int h = 0; h < (int)opposite.size(); ++h) {
    if (opposite[h] >= 0) continue;
    const Place& p = m.place[origin(mesh.tris, h)];
    const double b[3] = {p.b0, p.b1, p.b2};
    bool on_border = false;
    for (int i = 0; i < 3; ++i) on_border |= ref_opposite[3 * p.face + i] < 0 && b[(i + 2) % 3] == 0;
    EXPECT_TRUE(on_border) << origin(mesh.tris, h);
  }
}

TEST(PlaceOn, AMeshOfSomethingElseIsRefused) {
  Surface reference = sized(sphere(500), 500), mesh = reference;
  EXPECT_NO_THROW(place_on(mesh, reference));
  for (Vec3& p : mesh.points) p = p + Vec3{5, 0, 0};
  try {
    place_on(mesh, reference);
    FAIL();
  } catch (const NotAdmissible& e) {
    EXPECT_NE(std::string(e.what()).find("not one of the reference"), std::string::npos) << e.what();
  }
}

}  // namespace
