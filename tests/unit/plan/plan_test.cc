// SPDX-License-Identifier: BSD-3-Clause
#include "lib/plan/plan.h"

#include <gtest/gtest.h>

#include <numbers>

#include "lib/core/error.h"
#include "lib/feature/feature.h"
#include "lib/plan/bisect.h"
#include "lib/shape/shape.h"
#include "tests/unit/grid.h"
#include "tests/unit/parts.h"

using namespace meshpipe;
using std::numbers::pi;

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

TEST(Plan, ABorderThatCrossesItselfIsBent) {
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

// A long thimble: conformal in one chart, its end would be exp(-16) of its size.
TEST(Plan, APartThatWouldShrinkToNothingIsCutAcross) {
  auto thimble = grid(
      32, 48, true,
      [](double s, double t) {
        double a = 2 * pi * s, r = t < 0.999 ? 1 : 0.2;
        return Vec3{r * std::cos(a), r * std::sin(a), 10 * t};
      },
      all);
  int end = (int)thimble.points.size();
  for (const auto& loop : boundary_loops(opposite_halfedges(thimble.tris, end)))
    for (int h : loop)  // the small ring at the top is closed
      if (int v = origin(thimble.tris, h); thimble.points[v].z > 9)
        thimble.tris.push_back({target(thimble.tris, h), v, end});
  thimble.points.push_back({0, 0, 10});
  Surface s = one_part(thimble);
  std::vector<ParamReport> reports;
  Surface strict = s;
  ASSERT_EQ(map_surface(strict, 1, {.strict = true}, reports).size(), 1u);
  EXPECT_GT(reports[0].area_scale, 1e8);
  // joined from shards, which leave such a part without a map
  EXPECT_FALSE(map_surface(strict, 1, {.strict = true}, reports, std::vector<Chart>(1))[0].uv.empty());
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
TEST(Plan, EarsAreSplitThroughTheirThirdEdge) {
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

TEST(Plan, StrictRefusesWithTheReason) {
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

TEST(Plan, AcrossTheLongDirectionOrBetweenTwoPlaces) {
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

TEST(Plan, FacesBetweenModelEdgesAreTheFirstParts) {
  const Body body = cube(120);
  Surface s = surface_of(body);
  s.face.set("patch", body.patch);
  mark_features(s, {});
  const std::size_t n = s.points.size();
  EXPECT_EQ(partition_to_disks(s), 6);
  EXPECT_EQ(s.points.size(), n);
  const auto& part = s.face.get<int>("part");
  for (std::size_t t = 0; t < part.size(); ++t)
    for (std::size_t u = 0; u < t; ++u) EXPECT_EQ(part[t] == part[u], body.patch[t] == body.patch[u]);
}

// The strip's edges at x = 5 below y are model edges.
static Surface strip_with_line(double y) {
  Surface s = surface_of(grid(
      40, 4, false,
      [](double s, double t) {
        return Vec3{10 * s, t, 0};
      },
      all));
  std::vector<std::uint8_t> model(s.tris.size(), 0);
  for (std::size_t h = 0; h < 3 * s.tris.size(); ++h) {
    const Vec3 a = s.points[origin(s.tris, h)], b = s.points[target(s.tris, h)];
    if (a.x == 5 && b.x == 5 && a.y < y && b.y < y) model[h / 3] |= static_cast<std::uint8_t>(1 << h % 3);
  }
  s.face.set("model", std::move(model));
  return s;
}

TEST(Plan, ModelEdgesThatEndInsideAFaceDoNotDivideIt) {
  for (auto [y, parts] : {std::pair(0.9, 1), std::pair(2., 2)}) {
    Surface s = strip_with_line(y);
    EXPECT_EQ(partition_to_disks(s), parts);
  }
}

// Two triangles that meet in a vertex only are faces: the rest touches itself there.
TEST(Plan, AFaceThatTouchesItselfIsDivided) {
  Surface s = surface_of(grid(
      6, 6, false,
      [](double s, double t) {
        return Vec3{s, t, 0};
      },
      all));
  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  std::vector<std::uint8_t> model(s.tris.size(), 0);
  std::vector<int> around;  // half-edges that leave the vertex in the middle
  const Connectivity mesh{s, opposite};
  for (int h = 0; around.empty(); ++h)
    if (norm(mesh.point(mesh.from(h)) - Vec3{0.5, 0.5, 0}) < 1e-9)
      mesh.for_each_spoke(h, [&](int g) { around.push_back(g); });
  for (std::size_t i : {0, 2})
    for (int k = 0; k < 3; ++k) {
      const int h = 3 * (around[i] / 3) + k, o = opposite[h];
      model[h / 3] |= static_cast<std::uint8_t>(1 << h % 3);
      if (o >= 0) model[o / 3] |= static_cast<std::uint8_t>(1 << o % 3);
    }
  s.face.set("model", std::move(model));
  const int n = partition_to_disks(s);
  EXPECT_GT(n, 3);
  EXPECT_EQ(part_fault(s), "");
}

// A face with a handle is cut as any surface is; the triangle with model edges all around it stays one part.
TEST(Plan, AFaceWithAHandleIsCut) {
  Surface ring = surface_of(torus(0.4, 200));
  std::vector<std::uint8_t> model(ring.tris.size(), 0);
  model[0] = 7;
  const std::vector<int> opposite = opposite_halfedges(ring.tris, (int)ring.points.size());
  for (int h = 0; h < 3; ++h) model[opposite[h] / 3] |= static_cast<std::uint8_t>(1 << opposite[h] % 3);
  ring.face.set("model", model);
  EXPECT_GE(partition_to_disks(ring), 2);
  EXPECT_EQ(part_fault(ring), "");
  const auto& part = ring.face.get<int>("part");
  EXPECT_EQ(std::count(part.begin(), part.end(), part[0]), 1);
}

TEST(Plan, SliversOfACadBodyAreCutAlongModelEdges) {
  const Body body = cad_body(3, 3, 500);
  Surface s = surface_of(body);
  s.face.set("patch", body.patch);
  mark_features(s, {});
  std::vector<ParamReport> reports;
  map_surface(s, partition_to_disks(s), {}, reports);
  for (const ParamReport& r : reports) EXPECT_LT(r.anisotropy_p99, 20);
}

// A prism of needles, open at both ends, with nothing between its two rings: in a ring of the plane the
// needles would be sheared beyond use.
TEST(Plan, ACoarseTubeIsCutOpen) {
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

// A long tube open at both ends, with a ring of its own at one of them: the cut ends on the ring's border,
// where the ring's map gets a vertex and stays what it is elsewhere.
TEST(Plan, TheNeighborOfACutHasAMapWithItsNewVertices) {
  constexpr int n = 25, m = 37, rows = 34;
  Surface s = surface_of(round_tube(n, m, 3.3 * pi));
  std::vector<int> part(s.tris.size(), 0);
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = t >= 2 * n * rows;
  s.face.set("part", std::move(part));
  const SubMesh ring = split_by_label(s, s.face.get<int>("part"), 2)[1];
  ParamReport of_ring;
  const std::vector<Vec2> before = map_part(ring, {}, of_ring);
  std::vector<ParamReport> reports;
  const std::vector<Chart> charts = map_surface(s, 2, {}, reports);
  ASSERT_EQ(charts.size(), 3u);
  const Chart& after = charts[1];
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto at = std::find(after.mesh.vertex.begin(), after.mesh.vertex.end(), ring.vertex[i]);
    ASSERT_NE(at, after.mesh.vertex.end());
    EXPECT_EQ(after.uv[at - after.mesh.vertex.begin()], before[i]);
  }
  EXPECT_GT(after.uv.size(), (std::size_t)(m - rows) * n);
  EXPECT_TRUE(one_to_one(after.mesh, after.uv));
  const ParamReport again = distortion(after.mesh, after.uv);
  EXPECT_EQ(reports[1].anisotropy_p99, again.anisotropy_p99);
}
