// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param.h"

#include <gtest/gtest.h>

#include <numbers>

#include "lib/bisect.h"
#include "lib/error.h"
#include "lib/feature.h"
#include "lib/injective.h"
#include "lib/param_intrinsic.h"
#include "lib/partition.h"
#include "lib/shape.h"
#include "lib/topology.h"

using namespace meshpipe;
using std::numbers::pi;

// (i, j) -> (s, t) in the unit square -> space, in n x m quadrilaterals with `keep` deciding which are there;
// the columns s = 0 and s = 1 are one if `closed`. Diagonals alternate.
template <class Place, class Keep>
static SubMesh grid(int n, int m, bool closed, Place place, Keep keep) {
  Mesh mesh;
  int columns = closed ? n : n + 1;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < columns; ++i) mesh.points.push_back(place((double)i / n, (double)j / m));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      if (!keep(i, j)) continue;
      int a = j * columns + i, b = j * columns + (i + 1) % columns, c = b + columns, d = a + columns;
      if ((i + j) % 2) {
        mesh.tris.push_back({a, b, c});
        mesh.tris.push_back({a, c, d});
      } else {
        mesh.tris.push_back({a, b, d});
        mesh.tris.push_back({b, c, d});
      }
    }
  return split_by_label(mesh, std::vector<int>(mesh.tris.size(), 0), 1)[0];
}
static bool all(int, int) { return true; }

static std::vector<Vec2> conformal_map(const SubMesh& m) { return plain_map(m, {}); }
static std::vector<Vec2> convex_map(const SubMesh& m) { return plain_map(m, {.map = MapKind::convex}); }

static bool one_to_one(const SubMesh& m, const std::vector<Vec2>& uv) {
  return count_inverted(m.tris, uv) == 0 &&
         border_is_simple(m.tris, opposite_halfedges(m.tris, (int)m.points.size()), uv);
}
static ParamReport distortion(const SubMesh& m, const std::vector<Vec2>& uv) {
  ParamReport r;
  measure_distortion(m, uv, r);
  return r;
}

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

static Surface one_part(const Mesh& mesh) {
  Surface s = surface_of(mesh);
  s.face.set("part", std::vector<int>(s.tris.size(), 0));
  return s;
}

// A ramp that winds one and a half times round at the same radius: flat pieces of it overlap.
static Surface ramp() {
  auto m = grid(
      90, 6, false,
      [](double s, double t) {
        double a = 3 * pi * s, r = 1 + t;
        return Vec3{r * std::cos(a), r * std::sin(a), 0.6 * s};
      },
      all);
  for (Tri& t : m.tris) std::swap(t[1], t[2]);
  return one_part(m);
}

TEST(Param, ABorderThatCrossesItselfIsBent) {
  Surface s = ramp();
  std::size_t n = s.points.size();
  std::vector<ParamReport> reports;
  auto charts = map_surface(s, 1, {}, reports);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(s.points.size(), n);
  EXPECT_EQ(reports[0].used, MapKind::conformal);
  EXPECT_GT(reports[0].bend, 0);
  EXPECT_FALSE(reports[0].border_was_simple);
  EXPECT_LT(reports[0].anisotropy_p99, 1.2);  // still conformal
  EXPECT_TRUE(one_to_one(charts[0].mesh, charts[0].uv));
}

// A long thimble: conformal in one chart, its tip would be exp(-16) of its size.
TEST(Param, APartThatWouldShrinkToNothingIsCutAcross) {
  auto thimble = grid(
      32, 48, true,
      [](double s, double t) {
        double a = 2 * pi * s, r = t < 0.999 ? 1 : 0.2;
        return Vec3{r * std::cos(a), r * std::sin(a), 10 * t};
      },
      all);
  int tip = (int)thimble.points.size();
  for (const auto& loop : boundary_loops(opposite_halfedges(thimble.tris, tip)))
    for (int h : loop)  // the small ring at the top is closed
      if (int v = origin(thimble.tris, h); thimble.points[v].z > 9)
        thimble.tris.push_back({target(thimble.tris, h), v, tip});
  thimble.points.push_back({0, 0, 10});
  Surface s = one_part(thimble);
  std::vector<ParamReport> reports;
  Surface strict = s;
  ASSERT_EQ(map_surface(strict, 1, {.strict = true}, reports).size(), 1u);
  EXPECT_GT(reports[0].area_scale, 1e8);
  auto charts = map_surface(s, 1, {}, reports);
  ASSERT_EQ(charts.size(), 2u);
  for (int p = 0; p < 2; ++p) {
    EXPECT_LT(reports[p].area_scale, 1e8);
    EXPECT_TRUE(one_to_one(charts[p].mesh, charts[p].uv));
    for (int f : charts[p].mesh.face) EXPECT_EQ(s.face.get<int>("part")[f], p);
  }
}

//  3-----2   two ears, 0 1 2 and 0 2 3: the edge 0-2 is split once for both
//  |   / |
//  | /   |
//  0-----1
TEST(Param, EarsAreSplitThroughTheirThirdEdge) {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 3}};
  s.vertex.rows = 4;
  s.face.set("part", std::vector<int>{0, 0});
  Surface same = s;
  std::vector<ParamReport> reports;
  auto charts = map_surface(s, 1, {.map = MapKind::harmonic}, reports);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(s.points.size(), 5u);
  EXPECT_EQ(s.tris.size(), 4u);
  EXPECT_LT(reports[0].anisotropy_max, 1.01);  // four right isosceles triangles in a square
  map_surface(same, 1, {.map = MapKind::harmonic, .strict = true}, reports);
  EXPECT_EQ(same.points.size(), 4u);
}

TEST(Param, StrictRefusesWithTheReason) {
  Surface s = ramp();
  std::vector<ParamReport> reports;
  try {
    map_surface(s, 1, {.strict = true}, reports);
    FAIL();
  } catch (const GoalMissed& e) {
    EXPECT_NE(std::string(e.what()).find("part 0: the map is not one-to-one"), std::string::npos) << e.what();
  }
  EXPECT_EQ(*std::max_element(s.face.get<int>("part").begin(), s.face.get<int>("part").end()), 0);
}

TEST(Bisect, AcrossTheLongDirectionOrBetweenTwoPlaces) {
  auto strip = grid(
      40, 4, false,
      [](double s, double t) {
        return Vec3{10 * s, t, 0};
      },
      all);
  for (std::vector<std::array<int, 2>> apart : {std::vector<std::array<int, 2>>{}, {{0, 40}}}) {
    Surface s = one_part(strip);
    ASSERT_TRUE(bisect_part(s, 0, 1, apart));
    for (const Topology& t : topology_of_parts(s, s.face.get<int>("part"), 2)) {
      EXPECT_EQ(t.components, 1);
      EXPECT_EQ(t.genus, 0);
      EXPECT_EQ(t.loops, 1);
      EXPECT_NEAR(t.area, 5, 0.5);
      EXPECT_NEAR(t.longest_loop, 12, 1);
    }
  }
}

// Columns a tenth as wide each as the one before: half of the area is the first, half of the graph is not.
TEST(Bisect, EvenHalvesTheGraph) {
  auto strip = grid(
      20, 4, false,
      [](double s, double t) {
        return Vec3{-std::pow(10, -20 * s), t, 0};
      },
      all);
  Surface s = one_part(strip);
  ASSERT_TRUE(bisect_part(s, 0, 1, {}, true));
  for (const Topology& t : topology_of_parts(s, s.face.get<int>("part"), 2)) {
    EXPECT_EQ(t.components, 1);
    EXPECT_GT(t.faces, 160 / 4);
  }
}

//  +-----+-----+
//  |     |     |    a model line across: two parts, no new vertex
//  +-----+-----+
TEST(Bisect, AtModelEdgesThatEncloseSomething) {
  auto strip = grid(
      40, 4, false,
      [](double s, double t) {
        return Vec3{10 * s, t, 0};
      },
      all);
  Surface s = one_part(strip);
  auto mark = [&](double up_to) {  // the edges at x = 5 below y
    std::vector<std::uint8_t> model(s.tris.size(), 0);
    for (std::size_t h = 0; h < 3 * s.tris.size(); ++h) {
      const Vec3 a = s.points[origin(s.tris, h)], b = s.points[target(s.tris, h)];
      if (a.x == 5 && b.x == 5 && a.y < up_to && b.y < up_to) model[h / 3] |= 1 << h % 3;
    }
    s.face.set("model", std::move(model));
  };
  EXPECT_EQ(cut_along_model_edges(s, 0, 1), 1);  // no model edges
  mark(0.9);
  EXPECT_EQ(cut_along_model_edges(s, 0, 1), 1);  // they end inside
  mark(2);
  ASSERT_EQ(cut_along_model_edges(s, 0, 1), 2);
  EXPECT_EQ(s.points.size(), strip.points.size());
  for (const Topology& t : topology_of_parts(s, s.face.get<int>("part"), 2)) {
    EXPECT_EQ(t.components, 1);
    EXPECT_EQ(t.loops, 1);
    EXPECT_NEAR(t.area, 5, 1e-12);
  }
}

TEST(Bisect, AlongModelEdges) {
  const Body body = cube(120);
  Surface s = surface_of(body);
  s.face.set("patch", body.patch);
  s.face.set("part", std::vector<int>(s.tris.size(), 0));
  EXPECT_EQ(cut_along_model_edges(s, 0, 1), 1);  // none are known
  mark_features(s, {});
  EXPECT_EQ(cut_along_model_edges(s, 0, 1), 6);
  const auto& part = s.face.get<int>("part");
  for (std::size_t t = 0; t < part.size(); ++t)
    for (std::size_t u = 0; u < t; ++u) EXPECT_EQ(part[t] == part[u], body.patch[t] == body.patch[u]);
  // a piece with a handle stays in one part with the rest
  Surface ring;
  static_cast<Mesh&>(ring) = torus(0.4, 200);
  ring.vertex.rows = ring.points.size();
  ring.face.rows = ring.tris.size();
  ring.face.set("part", std::vector<int>(ring.tris.size(), 0));
  std::vector<std::uint8_t> model(ring.tris.size(), 0);
  model[0] = 7;  // all round one triangle
  const std::vector<int> opposite = opposite_halfedges(ring.tris, (int)ring.points.size());
  for (int h = 0; h < 3; ++h) model[opposite[h] / 3] |= static_cast<std::uint8_t>(1 << opposite[h] % 3);
  ring.face.set("model", model);
  EXPECT_EQ(cut_along_model_edges(ring, 0, 1), 1);
}

TEST(Param, SliversOfACadBodyAreCutAlongModelEdges) {
  const Body body = cad_body(3, 3, 500);
  Surface s = surface_of(body);
  s.face.set("patch", body.patch);
  mark_features(s, {});
  std::vector<ParamReport> reports;
  map_surface(s, partition_to_disks(s), {}, reports);
  for (const ParamReport& r : reports) EXPECT_LT(r.anisotropy_p99, 20);
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

TEST(Param, OptimisationLowersDistortionAndStaysOneToOne) {
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

// A prism of needles, open at both ends, with nothing between its two rings: in a ring of the plane the
// needles would be sheared beyond use.
TEST(Param, ACoarseTubeIsCutOpen) {
  auto prism = grid(
      64, 1, true,
      [](double s, double t) {
        double a = 2 * pi * s;
        return Vec3{std::cos(a), std::sin(a), 6 * t};
      },
      all);
  Surface s = one_part(prism);
  std::vector<ParamReport> reports;
  Surface strict = s;
  ASSERT_EQ(map_surface(strict, 1, {.strict = true}, reports).size(), 1u);
  EXPECT_GT(reports[0].anisotropy_mean, 4);
  auto charts = map_surface(s, 1, {}, reports);
  EXPECT_EQ(charts.size(), 2u);
  for (std::size_t p = 0; p < charts.size(); ++p) {
    EXPECT_LT(reports[p].anisotropy_mean, 1.1);
    EXPECT_TRUE(one_to_one(charts[p].mesh, charts[p].uv));
  }
}

// Of radius 1, open at both ends: n edges round, m along.
static Mesh round_tube(int n, int m, double length) {
  return grid(
      n, m, true,
      [length](double s, double t) {
        double a = 2 * pi * s;
        return Vec3{std::cos(a), std::sin(a), length * t};
      },
      all);
}

// A tube open at both ends, admissible as it is, with few edges round: a ring would shear its triangles.
TEST(Param, ALimbWithFewEdgesRoundIsCutAlong) {
  constexpr int n = 24, m = 22;
  Surface s = one_part(round_tube(n, m, 1.9 * pi));
  std::vector<ParamReport> reports;
  Surface strict = s, creased = s;
  map_surface(strict, 1, {.strict = true}, reports);
  EXPECT_GT(reports[0].anisotropy_median, 1.15);
  EXPECT_LT(reports[0].area_scale, 1e6);
  auto charts = map_surface(s, 1, {}, reports);
  ASSERT_EQ(charts.size(), 2u);
  for (const ParamReport& r : reports) {
    EXPECT_LT(r.anisotropy_median, 1.01);
    EXPECT_LT(r.area_scale, 2);
  }
  // not where the cut would cross a model edge: one round the middle
  std::vector<std::uint8_t> model(creased.tris.size(), 0);
  for (std::size_t t = 0; t < creased.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (creased.tris[t][i] / n == m / 2 && creased.tris[t][(i + 1) % 3] / n == m / 2)
        model[t] |= static_cast<std::uint8_t>(1 << i);
  creased.face.set("model", std::move(model));
  EXPECT_EQ(map_surface(creased, 1, {}, reports).size(), 1u);
}

// The same tube with a ring of its own at one end: the cut ends on the ring's border, whose map stays.
TEST(Param, TheMapOfANeighbourOfACutStays) {
  constexpr int n = 24, m = 27, rows = 24;
  Surface s = surface_of(round_tube(n, m, 2.3 * pi));
  std::vector<int> part(s.tris.size(), 0);
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = t >= 2 * n * rows;
  s.face.set("part", std::move(part));
  std::vector<ParamReport> reports;
  Surface strict = s;
  const Chart before = map_surface(strict, 2, {.strict = true}, reports)[1];
  const std::vector<Chart> charts = map_surface(s, 2, {}, reports);
  ASSERT_EQ(charts.size(), 3u);
  const Chart& after = charts[1];
  EXPECT_EQ(after.uv.size(), before.uv.size() + 2);
  EXPECT_TRUE(one_to_one(after.mesh, after.uv));
  for (std::size_t i = 0; i < before.uv.size(); ++i) {
    const auto& vertex = after.mesh.vertex;
    const auto k = std::find(vertex.begin(), vertex.end(), before.mesh.vertex[i]) - vertex.begin();
    ASSERT_LT(k, std::ssize(vertex));
    EXPECT_EQ(after.uv[k].x, before.uv[i].x);
    EXPECT_EQ(after.uv[k].y, before.uv[i].y);
  }
  const ParamReport again = distortion(after.mesh, after.uv);
  EXPECT_EQ(reports[1].anisotropy_p99, again.anisotropy_p99);
}
