// SPDX-License-Identifier: BSD-3-Clause
#include "lib/resolve/resolve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lib/clean/clean.h"
#include "lib/core/intersect.h"
#include "lib/core/topology.h"

using namespace meshpipe;

static void add(Surface& s, const std::vector<Vec3>& points, const std::vector<Tri>& tris, int patch) {
  const int n = (int)s.points.size();
  s.points.insert(s.points.end(), points.begin(), points.end());
  for (Tri t : tris) s.tris.push_back({t[0] + n, t[1] + n, t[2] + n});
  std::vector<int> patches = s.face.has("patch") ? s.face.get<int>("patch") : std::vector<int>{};
  patches.resize(s.tris.size(), patch);
  s.face.columns.clear();
  s.face.set("patch", patches);
  s.vertex.rows = s.points.size();
}

/// A box that the map `f` is applied to, oriented outward.
template <class Map>
static void add_box(Surface& s, Vec3 lo, Vec3 hi, Map f, int patch = 1) {
  std::vector<Vec3> p;
  for (int i = 0; i < 8; ++i)
    p.push_back(f(Vec3{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}));
  add(s, p,
      {{0, 2, 1},
       {1, 2, 3},
       {4, 5, 6},
       {5, 7, 6},
       {0, 1, 4},
       {1, 5, 4},
       {2, 6, 3},
       {3, 6, 7},
       {0, 4, 2},
       {2, 4, 6},
       {1, 3, 5},
       {3, 7, 5}},
      patch);
}
static void add_box(Surface& s, Vec3 lo, Vec3 hi, int patch = 1) {
  add_box(
      s, lo, hi, [](Vec3 p) { return p; }, patch);
}
static void add_tetrahedron(Surface& s, Vec3 o, double size) {
  add(s, {o, o + Vec3{size, 0, 0}, o + Vec3{0, size, 0}, o + Vec3{0, 0, size}},
      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, 1);
}

static double volume(const Mesh& s) {
  double v = 0;
  for (const Tri& t : s.tris) v += dot(s.points[t[0]], cross(s.points[t[1]], s.points[t[2]])) / 6;
  return v;
}

static ResolveReport expect_resolved(Surface& s, double expected) {
  const ResolveReport r = resolve(s);
  EXPECT_TRUE(r.closed);
  EXPECT_EQ(r.left, 0);
  EXPECT_TRUE(self_intersections(s).empty());
  EXPECT_NEAR(volume(s), expected, 1e-13 * expected);
  EXPECT_EQ(s.face.rows, s.tris.size());
  EXPECT_EQ(s.vertex.rows, s.points.size());
  return r;
}

static const Vec3 zero{0, 0, 0}, one{1, 1, 1}, two{2, 2, 2}, three{3, 3, 3};

TEST(Resolve, UnitesTetrahedra) {
  Surface s;
  add_tetrahedron(s, zero, 1);
  add_tetrahedron(s, {0.25, 0.25, 0.25}, 1);  // have in common one of size a quarter
  const ResolveReport r = expect_resolved(s, 2 / 6.0 - 1 / 384.0);
  EXPECT_EQ(r.new_vertices, 3);
  EXPECT_EQ(topology_of(s).genus, 0);
}

TEST(Resolve, UnitesBoxesAndKeepsThePatches) {
  Surface s;
  add_box(s, zero, two, 7);
  add_box(s, one, three, 8);
  const ResolveReport r = expect_resolved(s, 15);
  EXPECT_EQ(r.new_vertices, 6);
  EXPECT_EQ(r.dropped_area, 6);
  double area[2] = {0, 0};
  for (int t = 0; t < (int)s.tris.size(); ++t) {
    const Tri& v = s.tris[t];
    area[s.face.get<int>("patch")[t] - 7] +=
        0.5 * norm(area_vector(s.points[v[0]], s.points[v[1]], s.points[v[2]]));
  }
  EXPECT_EQ(area[0], 21);
  EXPECT_EQ(area[1], 21);
}

TEST(Resolve, UnitesBoxesThatSharePlanes) {
  Surface s;
  add_box(s, zero, two);
  add_box(s, {1, 1, 0}, {3, 3, 2});
  expect_resolved(s, 14);
  Surface stacked;
  add_box(stacked, zero, two);
  add_box(stacked, {0.5, 0.5, 2}, {1.5, 1.5, 3});
  EXPECT_EQ(expect_resolved(stacked, 9).dropped_area, 1);  // once, as the two sheets cancel
  Surface within;
  add_box(within, zero, two);
  add_box(within, {0, 0.5, 0.5}, {1, 1, 1});
  expect_resolved(within, 8);
}

TEST(Resolve, DropsWhatIsInsideAndKeepsCavities) {
  Surface s;
  add_box(s, zero, three);
  add_box(s, one, two);
  EXPECT_EQ(expect_resolved(s, 27).dropped, 12);
  Surface cavity;
  add_box(cavity, zero, three);
  add_box(cavity, one, two);
  for (std::size_t t = 12; t < 24; ++t) std::swap(cavity.tris[t][0], cavity.tris[t][1]);
  EXPECT_TRUE(resolve(cavity).nothing);
  for (Tri& t : cavity.tris) std::swap(t[0], t[1]);
  expect_resolved(cavity, 26);  // all inside out
  Surface twice;
  add_box(twice, zero, two);
  add_box(twice, zero, two);
  expect_resolved(twice, 8);
  EXPECT_EQ(twice.tris.size(), 12u);
}

TEST(Resolve, LeavesWhatTouchesInEdgesAndVerticesToBeSplit) {
  Surface s;
  add_box(s, zero, one);
  add_box(s, {1, 1, 0.25}, {2, 2, 0.75});
  EXPECT_EQ(expect_resolved(s, 1.5).new_vertices, 0);
  const CleanReport r = clean(s);
  EXPECT_EQ(r.paired_edges, 1);
  EXPECT_EQ(r.components, 2);
  Surface apart;
  add_box(apart, zero, one);
  add_box(apart, one, two);
  EXPECT_TRUE(resolve(apart).nothing);
}

/// Boxes in general position: the volume is compared with that of the same boxes after a rotation.
TEST(Resolve, IsTheSameInAnyPosition) {
  auto boxes = [](double angle) {
    const double c = std::cos(angle), d = std::sin(angle);
    auto rotated = [&](Vec3 p) {
      const Vec3 q{c * p.x - d * p.y, d * p.x + c * p.y, p.z};
      return Vec3{q.x, c * q.y - d * q.z, d * q.y + c * q.z};
    };
    Surface s;
    unsigned random = 1;
    auto next = [&] { return (double)((random = 1664525 * random + 1013904223) >> 28); };  // 0 to 15
    for (int i = 0; i < 20; ++i) {
      const Vec3 lo{next(), next(), next()};
      add_box(s, lo, lo + one + 0.25 * Vec3{next(), next(), next()}, rotated);
    }
    EXPECT_EQ(resolve(s).left, 0);
    return volume(s);
  };
  const double straight = boxes(0);
  EXPECT_EQ(straight, std::round(64 * straight) / 64);
  for (double angle : {1e-9, 0.3, 1.0}) EXPECT_NEAR(boxes(angle), straight, 1e-6) << angle;
}

TEST(Resolve, KeepsAllPiecesIfAsked) {
  Surface s;
  add_box(s, zero, two);
  add_box(s, one, three);
  const ResolveReport r = resolve(s, {.keep = ResolveOptions::all});
  EXPECT_EQ(r.dropped, 0);
  EXPECT_TRUE(self_intersections(s).empty());
  EXPECT_NEAR(total_area(s), 48, 1e-12);
}

TEST(Resolve, InterpolatesVertexData) {
  Surface s;
  add_box(s, zero, two);
  add_box(s, one, three);
  std::vector<double> x;
  for (Vec3 p : s.points) x.push_back(p.x + 10 * p.y + 100 * p.z);
  s.vertex.set("size", x);
  resolve(s);
  for (std::size_t v = 0; v < s.points.size(); ++v) {
    const Vec3 p = s.points[v];
    EXPECT_NEAR(s.vertex.get<double>("size")[v], p.x + 10 * p.y + 100 * p.z, 1e-12);
  }
}

static const std::vector<Tri> square{{0, 1, 2}, {1, 3, 2}};

TEST(Resolve, DropsWallsAndFinsOfSolids) {
  Surface s;
  add_box(s, zero, two);
  add(s, {{1, 0, 0}, {1, 2, 0}, {1, 0, 2}, {1, 2, 2}}, square, 2);
  EXPECT_EQ(expect_resolved(s, 8).dropped_area, 4);
  Surface fin;
  add_box(fin, zero, two);
  add(fin, {{1, 1, 0.5}, {3, 1, 0.5}, {1, 1, 1}, {3, 1, 1}}, square, 2);
  EXPECT_EQ(expect_resolved(fin, 8).dropped_area, 1);
}

TEST(Resolve, KeepsSheetsInFrontOfOthers) {
  Surface s;  // a box half sunk in the ground, whose front is above
  add(s, {{-9, -9, 0}, {9, -9, 0}, {-9, 9, 0}, {9, 9, 0}}, square, 1);
  add_box(s, {-1, -1, -1}, one, 2);
  const ResolveReport r = resolve(s);
  EXPECT_EQ(r.open, 1);
  EXPECT_FALSE(r.closed);
  EXPECT_TRUE(self_intersections(s).empty());
  EXPECT_NEAR(total_area(s), 18 * 18 + 4 * 2, 1e-12);
  EXPECT_EQ(topology_of(s).loops, 1);
  for (Vec3 p : s.points) EXPECT_GE(p.z, 0);
  Surface open;  // a box without a triangle is still in front of what is within it
  add_box(open, zero, two);
  open.tris.erase(open.tris.begin());
  open.face = {"face", open.tris.size(), {}};
  EXPECT_TRUE(resolve(open).nothing);
  add_box(open, one, three);
  EXPECT_EQ(resolve(open).dropped_area, 6);
  EXPECT_EQ(topology_of(open).loops, 1);
}

TEST(Resolve, DropsFoldsThatAreInsideOut) {
  Surface s;  // a prism; one of its edges has been pushed out through the opposite side
  add(s,
      {{0, 0, 0},
       {4, 0, 0},
       {4, 4, 0},
       {2, -1, 0},
       {0, 4, 0},
       {0, 0, 1},
       {4, 0, 1},
       {4, 4, 1},
       {2, -1, 1},
       {0, 4, 1}},
      {{0, 3, 1},
       {1, 3, 2},
       {0, 4, 3},
       {5, 6, 8},
       {6, 7, 8},
       {5, 8, 9},
       {0, 1, 6},
       {0, 6, 5},
       {1, 2, 7},
       {1, 7, 6},
       {2, 3, 8},
       {2, 8, 7},
       {3, 4, 9},
       {3, 9, 8},
       {4, 0, 5},
       {4, 5, 9}},
      1);
  ASSERT_NEAR(volume(s), 6, 1e-12);
  expect_resolved(s, 6.4);
}
