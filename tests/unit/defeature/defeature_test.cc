// SPDX-License-Identifier: BSD-3-Clause
#include "lib/defeature/defeature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "lib/core/bvh.h"
#include "lib/core/error.h"
#include "lib/core/topology.h"
#include "lib/feature/feature.h"

using namespace meshpipe;

namespace {

DefeatureReport remove(Surface& s, const DefeatureOptions& options, const std::vector<int>* given = nullptr) {
  std::vector<int> opposite = opposite_halfedges(s);
  return remove_small_features({s, opposite}, options, given);
}

constexpr double width = 0.01;  // of every small feature
constexpr double wide_enough = 1.05 * width, too_narrow = 0.95 * width;

/// The profile (x, z) along y = 0, 1, ..., ny; patch i is below the i-th piece of the profile. Marked edges
/// are the creases.
Surface extruded(const std::vector<Vec2>& profile, int ny) {
  Surface s;
  const int n = (int)profile.size();
  for (int j = 0; j <= ny; ++j)
    for (const Vec2& p : profile) s.points.push_back({p.x, (double)j, p.y});
  std::vector<int> patch;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const int a = j * n + i, b = a + 1, c = b + n, d = a + n;
      s.tris.push_back({a, b, c});
      s.tris.push_back({a, c, d});
      patch.insert(patch.end(), {i, i});
    }
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("patch", patch);
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  return s;
}

double farthest(const Mesh& from, const Mesh& to) {
  const Bvh tree(to);
  double most = 0;
  for (const Tri& t : from.tris)
    for (int i = 0; i <= 4; ++i)
      for (int j = 0; i + j <= 4; ++j) {
        const double a = i / 4.0, b = j / 4.0;
        const Vec3 p = (1 - a - b) * from.points[t[0]] + a * from.points[t[1]] + b * from.points[t[2]];
        most = std::max(most, tree.nearest(p).distance);
      }
  return most;
}

/// Removes features and checks what must be true of every result.
DefeatureReport removed(Surface& s, double tolerance) {
  const Surface before = s;
  const DefeatureReport r = remove(s, {tolerance});
  EXPECT_LE(r.moved, tolerance);
  EXPECT_LE(farthest(s, before), r.moved + 1e-9);
  EXPECT_LE(farthest(before, s), r.moved + 1e-9);
  const Topology t = topology_of(before), u = topology_of(s);
  EXPECT_EQ(std::tuple(t.components, t.genus, t.loops), std::tuple(u.components, u.genus, u.loops));
  EXPECT_EQ(s.vertex.rows, s.points.size());
  EXPECT_EQ(s.face.rows, s.tris.size());
  if (r.removed.empty()) {
    EXPECT_EQ(s.points, before.points);
    EXPECT_EQ(s.tris, before.tris);
    EXPECT_EQ(s.face.get<std::uint8_t>("model"), before.face.get<std::uint8_t>("model"));
  } else {
    EXPECT_EQ(r.face.size(), s.tris.size());
  }
  return r;
}

/// The profile's narrow pieces become lines at a tolerance above the width, and stay at one below.
void expect_removed(const std::vector<Vec2>& profile, std::vector<int> vanished) {
  Surface s = extruded(profile, 4);
  EXPECT_TRUE(removed(s, too_narrow).removed.empty());
  const DefeatureReport r = removed(s, wide_enough);
  ASSERT_EQ(r.removed.size(), 1u);
  EXPECT_NEAR(r.removed[0].width, width, 1e-9);
  EXPECT_NEAR(r.removed[0].length, 4, 0.05);
  EXPECT_EQ(r.vanished, vanished);
}

void expect_kept(const std::vector<Vec2>& profile, double tolerance = wide_enough) {
  Surface s = extruded(profile, 4);
  EXPECT_TRUE(removed(s, tolerance).removed.empty());
}

}  // namespace

TEST(Defeature, AStepVanishes) { expect_removed({{0, 0}, {1, 0}, {1, width}, {2, width}}, {1}); }

TEST(Defeature, AChamferBecomesOneLine) {
  const double leg = width / std::numbers::sqrt2;
  expect_removed({{0, 0}, {1, 0}, {1 + leg, -leg}, {1 + leg, -1}}, {1});
}

TEST(Defeature, ABluntEdgeBecomesSharp) { expect_removed({{0, 0}, {1, 0}, {1, -width}, {0, -0.5}}, {1}); }

TEST(Defeature, AShallowSlotLosesItsSides) {
  const std::vector<Vec2> slot{{0, 0}, {1, 0}, {1, -width}, {1.5, -width}, {1.5, 0}, {2.5, 0}};
  Surface s = extruded(slot, 4);
  EXPECT_TRUE(removed(s, too_narrow).removed.empty());
  EXPECT_EQ(removed(s, wide_enough).vanished, (std::vector<int>{1, 3}));
}

TEST(Defeature, TheBottomOfADeepSlotStays) {
  expect_kept({{0, 0}, {1, 0}, {1, -1}, {1 + width, -1}, {1 + width, 0}, {2, 0}});
}

TEST(Defeature, TheRimOfAThinPlateStays) { expect_kept({{0, 0}, {1, 0}, {1, -width}, {0, -width}}); }

TEST(Defeature, FineSurfacesStay) {
  std::vector<Vec2> fine;
  for (int i = 0; i <= 200; ++i) fine.push_back({0.005 * i, 0});
  fine.push_back({1, -1});
  Surface s = extruded(fine, 4);
  s.face.erase("patch");
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  EXPECT_TRUE(removed(s, wide_enough).removed.empty());
}

//  the section of a wing: its triangles get thinner than coordinates are exact, and lines nearer than the
//  tolerance, towards the edge at x = 1
//   ____-----____
//   |||||||||||||||:>
TEST(Defeature, ASharpTrailingEdgeStaysOneLine) {
  constexpr int n = 400;
  Surface s;
  auto add = [&](double x, double z) {
    for (double y : {-0.5, 0.5}) s.points.push_back({x, y, z});
  };
  add(1, 0);
  for (int i = 1; i <= n; ++i)
    for (int side : {1, -1}) {
      const double d = std::pow((double)i / n, 2);
      add(std::round(1e6 * (1 - d)) / 1e6, side * 0.14 * d);  // in six digits, as files have it
    }
  // of the pair i: above 4 i - 2, 4 i - 1; below 4 i, 4 i + 1; of the edge 0, 1
  auto quad = [&](int a, int b, int c, int d) { s.tris.insert(s.tris.end(), {Tri{a, b, c}, Tri{a, c, d}}); };
  for (int i = 1; i <= n; ++i) {
    const int up = 4 * i - 2, low = 4 * i, up0 = i > 1 ? up - 4 : 0, low0 = i > 1 ? low - 4 : 0;
    quad(up0, up0 + 1, up + 1, up);
    quad(low0 + 1, low0, low, low + 1);
    for (int y : {0, 1})
      for (Tri t : {Tri{up0, up, low0}, {low0, up, low}})
        if (i > 1 || t[0] != low0 || t[1] == up)
          if (t[0] != t[2] && t[0] != t[1]) s.tris.push_back(y ? Tri{t[1] + 1, t[0] + 1, t[2] + 1} : t);
  }
  quad(4 * n, 4 * n - 2, 4 * n - 1, 4 * n + 1);  // the blunt front
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  ASSERT_EQ(topology_of(s).loops, 0);
  auto lines_across = [&] {
    std::set<std::pair<int, int>> found;
    const std::vector<std::uint8_t>& model = s.face.get<std::uint8_t>("model");
    for (int h = 0; h < 3 * (int)s.tris.size(); ++h) {
      const int a = origin(s.tris, h), b = target(s.tris, h);
      if (model[h / 3] >> h % 3 & 1 && s.points[a].y * s.points[b].y < 0) found.insert(std::minmax(a, b));
    }
    return found.size();
  };
  mark_features(s, {FeatureOptions::automatic, 40, 20, 0.02});
  EXPECT_EQ(lines_across(), 3);  // two of the front
  remove(s, {0.0012});
  mark_features(s, {FeatureOptions::automatic, 40, 20, 0.02});
  EXPECT_EQ(lines_across(), 3);
}

//  #: lines; corners are nearer than the tolerance, and o is on no line
//   --#-----#--
//     |  o  |
//   --#-----#--
TEST(Defeature, VerticesOffLinesAreAmongCorners) {
  std::vector<Vec2> profile;
  for (int i = 0; i <= 10; ++i) profile.push_back({0.1 * i, 0});
  Surface s = extruded(profile, 10);
  for (Vec3& p : s.points) p.y *= 0.1;
  std::vector<std::uint8_t> model(s.tris.size(), 0);
  for (int h = 0; h < 3 * (int)s.tris.size(); ++h) {
    const int a = origin(s.tris, h), b = target(s.tris, h);
    const bool along = a % 11 == b % 11 && (a % 11 == 4 || a % 11 == 6);
    if (along || (a / 11 == b / 11 && (a / 11 == 4 || a / 11 == 6))) model[h / 3] |= 1 << h % 3;
  }
  s.face.set("model", model);
  removed(s, 0.7);
}

TEST(Defeature, VerticesOfTwoFansAreRefused) {
  Surface s = extruded({{0, 0}, {1, 0}, {1, -width}, {2, -width}}, 2);
  const int n = (int)s.points.size();
  s.points.insert(s.points.end(), {{0, -1, 0}, {1, -1, 0}});
  s.tris.push_back({0, n, n + 1});
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("patch", std::vector<int>(s.tris.size(), 0));
  s.face.set("model", std::vector<std::uint8_t>(s.tris.size(), 0));
  EXPECT_THROW(remove(s, {wide_enough}), NotAdmissible);
}

TEST(Defeature, ToleranceZeroRemovesNothing) {
  Surface s = extruded({{0, 0}, {1, 0}, {1, 1e-12}, {2, 1e-12}}, 4);
  EXPECT_TRUE(removed(s, 0).removed.empty());
}

TEST(Defeature, BordersThatAreKeptDoNotMove) {
  Surface s = extruded({{0, 0}, {1, 0}, {1, width}, {2, width}}, 4);
  const Surface before = s;
  remove(s, {wide_enough, true});
  const Bvh tree(s);
  for (const Vec3& p : before.points) EXPECT_TRUE((p.y > 0 && p.y < 4) || tree.nearest(p).distance == 0);
}

// A strip goes where its vertices move in the planes that stay, and stays where they would leave them.
TEST(Defeature, PlanesThatAreKeptStayPlane) {
  for (const bool step : {false, true}) {
    Surface s =
        extruded({{0, 0}, {1, 0}, {1 + (step ? 0 : width), step ? width : 0}, {2, step ? width : 0}}, 4);
    DefeatureOptions o{wide_enough};
    o.plane.assign(s.tris.size(), 1);
    EXPECT_EQ(remove(s, o).removed.empty(), step);
  }
}

TEST(Defeature, ColumnsFollow) {
  Surface s = extruded({{0, 0}, {1, 0}, {1, width}, {2, width}}, 4);
  std::vector<double> y;
  for (const Vec3& p : s.points) y.push_back(p.y);
  s.vertex.set("y2", y);
  removed(s, wide_enough);
  for (std::size_t v = 0; v < s.points.size(); ++v) EXPECT_EQ(s.vertex.get<double>("y2")[v], s.points[v].y);
  for (std::size_t t = 0; t < s.tris.size(); ++t)
    EXPECT_EQ(s.face.get<int>("patch")[t], centroid(s, (int)t).x < 1 ? 0 : 2);
}

/// Two lines with vertices at different places, joined by caps: no two vertices are closer than 0.2.
TEST(Defeature, LinesNeedNoVerticesOppositeEachOther) {
  Surface s;
  for (int i = 0; i <= 10; ++i) s.points.push_back({(double)i, -3, 0});
  const int p = (int)s.points.size();
  for (int i = 0; i <= 10; ++i) s.points.push_back({(double)i, 0, 0});
  const int q = (int)s.points.size();
  for (int i = 0; i <= 10; ++i) s.points.push_back({i == 0 || i == 10 ? i : i + 0.3, 0, width});
  const int r = (int)s.points.size();
  for (int i = 0; i <= 10; ++i) s.points.push_back({(double)i, 3, width});
  std::vector<int> patch;
  for (const auto& [a, b] : {std::pair{0, p}, {p, q}, {q, r}})
    for (int i = 0; i < 10; ++i) {
      patch.insert(patch.end(), {a, a});
      s.tris.push_back({a + i, a + i + 1, b + i});
      s.tris.push_back({a + i + 1, b + i + 1, b + i});
    }
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("patch", patch);
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  EXPECT_TRUE(removed(s, too_narrow).removed.empty());
  const DefeatureReport report = removed(s, wide_enough);
  ASSERT_EQ(report.removed.size(), 1u);
  EXPECT_NEAR(report.removed[0].length, 10, 0.05);
  for (std::size_t t = 0; t < s.tris.size(); ++t) EXPECT_GT(triangle_area(s, (int)t), 0.1);
}

//  p'--a'--a''--q'   the wall p-a-q has a corner at a; at its top, a'' is off a' by the width, so that the
//  |  / | / ___/ |   sliver a-a''-a' lies between two creases that meet at a
//  p----a--------q
TEST(Defeature, ASliverBetweenWallsCloses) {
  Surface s;
  s.points = {{-1, 0, 0}, {0, 0, 0}, {1, -1, 0}, {-1, 0, 3}, {0, 0, 3}, {0, width, 3}, {1, -1, 3}};
  enum { p, a, q, p1, a1, a2, q1 };
  s.tris = {{p, a, p1}, {p1, a, a1}, {a, a2, a1}, {a, q, q1}, {a, q1, a2}, {p1, a1, a2}, {p1, a2, q1}};
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("patch", std::vector<int>(s.tris.size(), 0));
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  EXPECT_TRUE(removed(s, too_narrow).removed.empty());
  EXPECT_EQ(removed(s, wide_enough).removed.size(), 1u);
  EXPECT_EQ(s.points.size(), 6u);
}

/// A wall below the crease a-b and a deck behind a second crease a-c-b, with the sliver a-b-c between them:
///
///          c___             the edge a-c is too short for the tolerance, but part of a long line
///       /       -------___
///     a --------------------- b
Surface with_sliver(double x, double y) {  // c
  Surface s;
  s.points = {{0, 0, 0}, {4, 0, 0}, {x, y, 0}, {0, 0, -2}, {4, 0, -2}, {-3, 0.2, 0}, {4, 3, 0}};
  enum { a, b, c, a1, b1, a2, b2 };
  s.tris = {{a, b, c}, {b, a, a1}, {b, a1, b1}, {c, b, b2}, {c, b2, a2}, {a, c, a2}};
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("model", std::vector<std::uint8_t>{7, 1, 0, 1, 0, 1});
  return s;
}

TEST(Defeature, ASliverBetweenCreasesThatMeetClosesAtTheNearestPoint) {
  Surface s = with_sliver(0.8 * width, 0.3 * width);
  EXPECT_TRUE(removed(s, 0.29 * width).removed.empty());
  const DefeatureReport r = removed(s, width);
  ASSERT_EQ(r.removed.size(), 1u);
  EXPECT_NEAR(r.removed[0].width, 0.3 * width, 1e-9);
  EXPECT_EQ(s.points.size(), 7u);  // c is on a-b
  EXPECT_EQ(s.tris.size(), 6u);
}

TEST(Defeature, NoVertexIsMadeNextToTheEndOfAnEdge) {
  Surface s = with_sliver(0.2 * width, 0.99 * width);  // a-c is longer than the tolerance
  EXPECT_TRUE(removed(s, width).removed.empty());
}

/// A wall below the crease a-b, and two decks that slope down from the crease c-d, which ends near it:
///
///     e ------- d ------- f
///     |         |         |
///     |         |         |       the sliver a-b-c is no strip: no line runs along a-b
///     |    __---c---__    |
///     a ----------------- b
TEST(Defeature, ALineThatEndsNextToAnotherGoesOnToIt) {
  Surface s;
  s.points = {{0, 0, 0},    {4, 0, 0},    {2, 0.5 * width, 0}, {2, 3, 0},
              {0, 3, -1.4}, {4, 3, -1.4}, {0, 0, -2},          {4, 0, -2}};
  enum { a, b, c, d, e, f, a1, b1 };
  s.tris = {{a, b, c}, {b, a, a1}, {b, a1, b1}, {a, c, e}, {c, d, e}, {c, f, d}, {b, f, c}};
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("model", std::vector<std::uint8_t>{1, 1, 0, 0, 1, 4, 0});
  EXPECT_TRUE(removed(s, 0.49 * width).removed.empty());
  const DefeatureReport r = removed(s, width);
  ASSERT_EQ(r.removed.size(), 1u);
  EXPECT_NEAR(r.removed[0].width, 0.5 * width, 1e-9);
  EXPECT_EQ(s.points.size(), 8u);  // c is on a-b
  for (Vec3 p : s.points)
    if (p.z == 0 && p.y < 1) {
      EXPECT_EQ(p.y, 0);
    }
}

/// A wall below the crease a-b and a deck behind the crease a-p-b, which turns by 33 degrees at p:
///
///     u ------------------- v
///     |   __________-----p  |     p-b is a part of a long line, and the only short edge of the strip
///     a ------------------- b
TEST(Defeature, AStripClosesAtAnEdgeOfALongLine) {
  const double turn = 33 * std::numbers::pi / 180, l = 0.28 * width;
  Surface s;
  s.points = {
      {0, 0, 0}, {4 + l * std::cos(turn), 0, 0}, {4, l * std::sin(turn), 0}, {0, 3, 3}, {5, 3, 3}, {0, 0, -2},
      {4, 0, -2}};
  enum { a, b, p, u, v, a1, b1 };
  s.tris = {{a, b, p}, {b, a, a1}, {b, a1, b1}, {a, p, u}, {p, v, u}, {p, b, v}};
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("model", std::vector<std::uint8_t>{7, 1, 0, 1, 0, 1});
  ASSERT_EQ(removed(s, width).removed.size(), 1u);
  EXPECT_EQ(s.points.size(), 6u);
  EXPECT_EQ(s.tris.size(), 4u);
}

/// Three faces of a sheared box at its corner o, with a vertex v on one of the edges:
///
///     z
///     |           v is nearer to o than the tolerance, and leans over o-x. Nothing is narrow here.
///     v
///   / o------ x
///  y
TEST(Defeature, ACornerNextToAVertexOfAnEdgeStays) {
  Surface s;
  s.points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.4, 0, 2}, {0.16 * width, 0, 0.8 * width}};
  enum { o, x, y, z, v };
  s.tris = {{o, x, v}, {v, x, z}, {v, z, y}, {v, y, o}, {y, x, o}};
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("model", std::vector<std::uint8_t>{5, 4, 1, 6, 6});
  EXPECT_TRUE(removed(s, width).removed.empty());
  EXPECT_EQ(s.points.size(), 5u);
}

//  p'---a'---q'   two walls meet in a crease that ends at a on the border; a cut of the model has left the
//  |  / |  / |    ear a-e-q, at right angles to its wall, with the short border edge a-e
//  p----a====q
TEST(Defeature, AnEarAtTheEndOfACreaseIsCutOff) {
  Surface s;
  s.points = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 0, 3}, {0, 0, 3}, {0, 1, 3}, {width, 0, 0}};
  enum { p, a, q, p1, a1, q1, e };
  s.tris = {{p, a, p1}, {p1, a, a1}, {a, q, q1}, {a, q1, a1}, {q, a, e}};
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  EXPECT_TRUE(removed(s, too_narrow).removed.empty());
  EXPECT_EQ(removed(s, wide_enough).removed.size(), 1u);
  EXPECT_EQ(s.tris.size(), 4u);
}

TEST(Defeature, GivenLinesAreKeptOrFollow) {
  Surface s = extruded({{0, 0}, {1, 0}, {1, width}, {2, width}}, 4);
  std::vector<int> given(3 * s.tris.size(), -1);  // line 7 along the lower edge of the step
  for (int h = 0; h < (int)given.size(); ++h)
    if (const Vec3 a = s.points[origin(s.tris, h)], b = s.points[target(s.tris, h)]; a.x == 1 && b.x == 1)
      if (a.z == 0 && b.z == 0) given[h] = 7;
  s.face.erase("patch");
  const DefeatureReport r = remove(s, {wide_enough}, &given);
  double length = 0;
  for (int h = 0; h < (int)r.given.size(); ++h)
    if (r.given[h] == 7) {
      EXPECT_EQ(s.points[origin(s.tris, h)].z, 0);
      length += edge_length(s, h);
    }
  EXPECT_EQ(length, 8);  // on both sides
}

TEST(Defeature, TheRemarkHoldsTheDistance) {
  DefeatureReport r;
  r.moved = 0.1;
  r.removed.resize(3);
  EXPECT_EQ(moved_by(remark_of(r)), 0.1);
  EXPECT_EQ(moved_by("clean opened 1 split 2 dropped 3"), 0);
}

TEST(Defeature, TheEndOfARodStays) {
  Surface s;  // 0.008 x 0.008 x 1
  for (int k = 0; k < 2; ++k)
    for (int i : {0, 1, 3, 2}) s.points.push_back({0.008 * (i & 1), 0.008 * (i >> 1), (double)k});
  s.tris = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    s.tris.push_back({i, j, j + 4});
    s.tris.push_back({i, j + 4, i + 4});
  }
  s.vertex.rows = 8, s.face.rows = s.tris.size();
  mark_features(s, {FeatureOptions::angles, 40, 20, 1e-3});
  EXPECT_TRUE(removed(s, 2 * width).removed.empty());
}

/// A square of side 2 and above it, at z = height, a triangle that ends at x = end.
Surface with_flap(double height, double end) {
  Surface s = extruded({{0, 0}, {1, 0}, {2, 0}}, 2);
  s.points.insert(s.points.end(), {{0.5, 0.5, height}, {end, 0.5, height}, {0.5, 1.5, height}});
  s.tris.push_back({9, 10, 11});
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("patch", std::vector<int>(s.tris.size(), 0));
  s.face.get<int>("patch").back() = 1;
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  return s;
}

TEST(Defeature, AFragmentWithinTheToleranceOfTheRestIsRemoved) {
  Surface s = with_flap(too_narrow, 1.5);
  const Surface before = s;
  const DefeatureReport r = remove(s, {width});
  ASSERT_EQ(r.removed.size(), 1u);
  EXPECT_NEAR(r.removed[0].width, too_narrow, 0.03 * width);
  EXPECT_NEAR(r.removed[0].length, std::numbers::sqrt2, 1e-9);
  EXPECT_EQ(r.vanished, std::vector<int>{1});
  EXPECT_EQ(s.tris.size(), before.tris.size() - 1);
  EXPECT_EQ(s.points.size(), before.points.size() - 3);
  EXPECT_LE(farthest(before, s), r.moved);
  EXPECT_LE(r.moved, width);
}

TEST(Defeature, AFragmentFartherThanTheToleranceStays) {
  for (Surface s : {with_flap(wide_enough, 1.5), with_flap(too_narrow, 2.1)}) {
    const std::size_t n = s.tris.size();
    EXPECT_TRUE(remove(s, {width}).removed.empty());
    EXPECT_EQ(s.tris.size(), n);
  }
}

// the rest has many triangles below the fragment
TEST(Defeature, AFragmentMayBeLargerThanTheTrianglesBelow) {
  Surface s;
  const int n = 20;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) s.points.push_back({0.1 * i, 0.1 * j, 0});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      s.tris.insert(s.tris.end(), {{a, a + 1, a + n + 2}, {a, a + n + 2, a + n + 1}});
    }
  const int first = (int)s.points.size();
  s.points.insert(s.points.end(),
                  {{0.53, 0.54, 0.5 * width}, {1.25, 0.57, 0.5 * width}, {0.58, 1.23, 0.5 * width}});
  s.tris.push_back({first, first + 1, first + 2});
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  const DefeatureReport r = remove(s, {width});
  ASSERT_EQ(r.removed.size(), 1u);
  EXPECT_NEAR(r.removed[0].width, 0.5 * width, 1e-12);
}

// one far from the rest costs no more than one near to it
TEST(Defeature, ManyFragmentsFarFromTheRestStay) {
  Surface s = extruded({{0, 0}, {100, 0}}, 1);
  for (int i = 0; i < 50000; ++i) {
    const double x = i % 250, y = i / 250;
    const int v = (int)s.points.size();
    s.points.insert(s.points.end(), {{x, y, 9000}, {x + 0.5, y, 9000}, {x, y + 0.5, 9000}});
    s.tris.push_back({v, v + 1, v + 2});
  }
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("patch", std::vector<int>(s.tris.size(), 0));
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  EXPECT_TRUE(remove(s, {width}).removed.empty());
}

TEST(Defeature, AFragmentThatIsKeptStays) {
  Surface s = with_flap(too_narrow, 1.5);
  DefeatureOptions options{width};
  options.kept.assign(s.tris.size(), 0);
  options.kept.back() = 1;
  EXPECT_TRUE(remove(s, options).removed.empty());
}

// a wall with its foot on the border A T B E, and a roof from the crease W G E; G is just above B
Surface with_ear() {
  Surface s;
  enum { A, T, B, E, G, W, X, Y };
  s.points = {{0, 0, 0},          {1, 0, 0}, {2, 0, 0}, {3, 0, 0},  //
              {2, 0, too_narrow}, {0, 0, 1}, {0, 1, 1}, {3, 1, 0}};
  s.tris = {{A, T, G}, {T, B, G}, {B, E, G}, {A, G, W}, {W, G, X}, {G, E, Y}, {G, Y, X}};
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  return s;
}

TEST(Defeature, AnEarThatAMergeLeavesWithoutHeightIsCutOff) {
  Surface s = with_ear();
  const DefeatureReport r = removed(s, width);
  EXPECT_EQ(r.removed.size(), 1u);
  EXPECT_EQ(s.tris.size(), 4u);
  EXPECT_EQ(s.points.size(), 6u);
}

// the same with the vertices of the border kept
TEST(Defeature, NoEarIsCutOffABorderThatIsKept) {
  Surface s = with_ear();
  const std::size_t n = s.points.size();
  const DefeatureReport r = remove(s, {width, true});
  EXPECT_TRUE(r.removed.empty());
  EXPECT_EQ(s.points.size(), n);
}

//  X--------------------O    G is just off the border at X; once they were merged, X O G would be a spike,
//   `-G---------...           without height, but its corner O is far from the rest
//   K  `
TEST(Defeature, ASpikeThatAMergeWouldLeaveStays) {
  Surface s;
  enum { X, O, G, K, P, Q };
  s.points = {{0, 0, 0}, {5, 0, 0}, {0.005, 0.002, 0}, {-0.01, 0, 0}, {0, -10, 0}, {-2, -10, 0}};
  s.tris = {{X, O, G}, {X, G, K}, {X, K, P}, {K, Q, P}};
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("patch", std::vector<int>{1, 2, 3, 3});
  mark_features(s, {FeatureOptions::angles, 40, 20, 0});
  const Surface before = s;
  const DefeatureReport r = removed(s, 3 * width);
  EXPECT_LE(farthest(before, s), 3 * width);
  EXPECT_LE(farthest(before, s), r.moved + 1e-12);
}
