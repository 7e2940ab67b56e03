// SPDX-License-Identifier: BSD-3-Clause
#include "lib/clean/clean.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <tuple>

#include "lib/core/error.h"
#include "lib/core/junctions.h"
#include "lib/core/topology.h"
#include "lib/core/weld.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

static Surface surface(std::vector<Vec3> points, std::vector<Tri> tris) {
  Surface s;
  s.points = std::move(points);
  s.tris = std::move(tris);
  std::vector<int> patch;
  for (int t = 0; t < (int)s.tris.size(); ++t) patch.push_back(10 + t);
  s.face.set("patch", patch);
  return s;
}

static const std::vector<Vec3> tetra_points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const std::vector<Tri> tetra_tris{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

/// Every triangle on its own three points, as STL has them.
static Surface soup(const std::vector<Vec3>& points, const std::vector<Tri>& tris) {
  Surface s = surface({}, tris);
  for (Tri& t : s.tris)
    for (int& v : t) {
      s.points.push_back(points[v]);
      v = (int)s.points.size() - 1;
    }
  return s;
}

static void expect_manifold(const Surface& s) {
  auto o = opposite_halfedges(s.tris, (int)s.points.size());
  EXPECT_EQ(find_pinched_vertex({s, o}), -1);
  EXPECT_EQ(s.face.get<int>("patch").size(), s.tris.size());
}

static double volume(const Surface& s) {
  double v = 0;
  for (const Tri& t : s.tris) v += dot(s.points[t[0]], cross(s.points[t[1]], s.points[t[2]])) / 6;
  return v;
}

TEST(Clean, LeavesACleanSurfaceAsItIs) {
  Surface s = surface(tetra_points, tetra_tris);
  EXPECT_TRUE(clean(s).nothing);
  EXPECT_EQ(s.tris, tetra_tris);
  EXPECT_EQ(s.points, tetra_points);
}

TEST(Clean, WeldsASoupByFirstUseAndTakesMinusZeroForZero) {
  Surface s = soup(tetra_points, tetra_tris);
  s.points[3].x = -0.0;
  CleanReport r = clean(s);
  EXPECT_EQ(r.welded, 8);
  EXPECT_EQ(s.points.size(), 4u);
  EXPECT_EQ(s.tris[0], (Tri{0, 1, 2}));
  EXPECT_EQ(s.points[1], (Vec3{0, 1, 0}));  // the second corner of the first triangle
  EXPECT_NEAR(volume(s), 1.0 / 6, 1e-15);
  expect_manifold(s);
}

TEST(Clean, TurnsTheMinorityAndTheInsideOut) {
  Surface s = surface(tetra_points, tetra_tris);
  std::swap(s.tris[2][0], s.tris[2][1]);
  EXPECT_EQ(clean(s).flipped, 1);
  EXPECT_GT(volume(s), 0);
  for (Tri& t : s.tris) std::swap(t[1], t[2]);
  EXPECT_EQ(clean(s).flipped, 4);
  EXPECT_GT(volume(s), 0);
  expect_manifold(s);
}

/// Nested tetrahedra, largest first, those with a minus inside out.
static Surface nested(const std::string& signs) {
  Surface s;
  double size = 1;
  for (char sign : signs) {
    const int first = (int)s.points.size();
    for (Vec3 p : tetra_points)
      s.points.push_back(Vec3{0.2, 0.21, 0.22} + size * (p - Vec3{0.2, 0.21, 0.22}));
    for (Tri t : tetra_tris) {
      for (int& v : t) v += first;
      if (sign == '-') std::swap(t[1], t[2]);
      s.tris.push_back(t);
    }
    size /= 3;
  }
  s.face.set("patch", std::vector<int>(s.tris.size(), 1));
  return s;
}

TEST(Clean, FacesOutOfWhatIsEnclosed) {
  for (const char* consistent : {"+", "+-", "+-+", "+-+-", "++", "+++"}) {
    Surface s = nested(consistent);
    const std::vector<Tri> before = s.tris;
    EXPECT_TRUE(clean(s).nothing) << consistent;
    EXPECT_EQ(s.tris, before);
  }
  for (auto [given, expected, reversed] :
       {std::tuple{"-", "+", 4}, {"-+", "+-", 8}, {"--", "+-", 4}, {"-+-", "+-+", 12}}) {
    Surface s = nested(given);
    const CleanReport r = clean(s);
    EXPECT_EQ(r.flipped, reversed) << given;
    EXPECT_EQ((int)r.offending.size(), reversed) << given;
    const Surface result = nested(expected);
    for (int c = 0; c < (int)s.tris.size() / 4; ++c) {
      auto part = [&](const Surface& whole) {
        return volume(surface(whole.points, {whole.tris.begin() + 4 * c, whole.tris.begin() + 4 * c + 4}));
      };
      EXPECT_GT(part(s) * part(result), 0) << given << ' ' << c;
    }
    EXPECT_TRUE(clean(s).nothing) << given;
  }
}

TEST(Clean, ManyTrianglesInLineTakeLittleTime) {
  // a vertex on the line of the others: all but the last triangle of its fan are flat
  const int n = 60000;
  std::vector<Vec3> points{{0, 0, 0}};
  std::vector<Tri> tris;
  for (int i = 1; i <= n; ++i) points.push_back({(double)i, 0, 0});
  points.push_back({0, 1, 0});
  for (int i = 1; i < n; ++i) tris.push_back({0, i, i + 1});
  tris.push_back({0, n, n + 1});
  Surface s = surface(points, tris);
  clean(s);
  for (const Tri& t : s.tris) EXPECT_GT(norm(area_vector(s.points[t[0]], s.points[t[1]], s.points[t[2]])), 0);
  EXPECT_TRUE(clean(s).nothing);
}

TEST(Clean, OneVertexFarOffDoesNotSlowTheWeld) {
  const int n = 300;
  std::vector<Vec3> points;
  std::vector<Tri> tris;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) points.push_back({(double)x, (double)y, 0});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x;
      tris.push_back({a, a + 1, a + n + 2});
      tris.push_back({a, a + n + 2, a + n + 1});
    }
  points.push_back({1e40, 3e20, -1e40});
  tris.push_back({0, n + 1, (int)points.size() - 1});
  for (double tolerance : {0.001, 1e-300}) {
    Surface s = surface(points, tris);
    EXPECT_EQ(clean(s, {.weld = tolerance}).welded_near, 0);
  }
}

TEST(Clean, DropsDuplicatesDegeneratesAndUnreferencedVertices) {
  Surface s = surface(tetra_points, tetra_tris);
  s.points.push_back({5, 5, 5});
  s.tris.insert(s.tris.begin() + 1, {{2, 1, 0}, {3, 3, 1}});  // one again, reversed; one with a vertex twice
  s.face.columns.clear();
  s.face.set<int>("patch", {0, 1, 2, 3, 4, 5});
  s.vertex.set<double>("size", {1, 2, 3, 4, 5});
  CleanReport r = clean(s);
  EXPECT_EQ(r.duplicate, 1);
  EXPECT_EQ(r.degenerate, 1);
  EXPECT_EQ(r.unreferenced, 1);
  EXPECT_EQ(s.face.get<int>("patch"), (std::vector<int>{0, 3, 4, 5}));
  EXPECT_EQ(s.vertex.get<double>("size"), (std::vector<double>{1, 3, 2, 4}));
  EXPECT_EQ(s.tris.size(), 4u);
  expect_manifold(s);
}

//  1---2
//   \ /        two triangles that meet at vertex 0 only
//    0
//   / \        .
//  3---4
TEST(Clean, SplitsAPinchedVertexIntoOneCopyAFan) {
  Surface s = surface({{0, 0, 0}, {-1, 1, 0}, {1, 1, 0}, {-1, -1, 0}, {1, -1, 0}}, {{0, 2, 1}, {0, 3, 4}});
  CleanReport r = clean(s);
  EXPECT_EQ(r.nonmanifold_vertices, 1);
  ASSERT_EQ(s.points.size(), 6u);
  EXPECT_EQ(s.points[5], s.points[0]);
  EXPECT_EQ(s.tris[0], (Tri{0, 2, 1}));
  EXPECT_EQ(s.tris[1], (Tri{5, 3, 4}));
  expect_manifold(s);
  // what it has split it does not weld again
  const std::vector<Tri> before = s.tris;
  EXPECT_TRUE(clean(s).nothing);
  EXPECT_EQ(s.tris, before);
}

TEST(Clean, SplitsThreeSheetsOnOneEdge) {
  Surface s =
      surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  CleanReport r = clean(s);
  EXPECT_EQ(r.nonmanifold_edges, 1);
  EXPECT_EQ(r.nonmanifold_vertices, 2);
  EXPECT_EQ(r.copies, 4);
  EXPECT_EQ(s.points.size(), 9u);
  expect_manifold(s);
}

TEST(Clean, RemarksWhatTheTopologyHides) {
  Surface s = surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                      {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 4}});
  const std::string remark = remark_of(clean(s));
  EXPECT_EQ(remark, "clean opened 1 split 2 dropped 1");
  EXPECT_EQ(parse_remark(remark).opened, 1);
  EXPECT_EQ(parse_remark(remark).split, 2);
  EXPECT_EQ(parse_remark(remark).dropped, 1);
  EXPECT_EQ(parse_remark("cleaned by hand").opened, 0);
  EXPECT_EQ(remark_of(clean(s)), "clean opened 1 split 2 dropped 0");
}

TEST(Clean, KeepsSheetsJoinedOnRequest) {
  // the same three sheets on the edge 0-1: two of them of one patch
  Surface s =
      surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  s.face.set<int>("patch", {7, 8, 7});
  const std::vector<Tri> before = s.tris;
  CleanReport r = clean(s, {.sheets = CleanOptions::keep});
  EXPECT_EQ(r.nonmanifold_edges, 1);
  EXPECT_EQ(r.copies, 0);
  EXPECT_EQ(r.components, 3);
  EXPECT_FALSE(r.nothing);
  EXPECT_EQ(s.tris, before);
  EXPECT_EQ(s.points.size(), 5u);
  EXPECT_EQ(s.face.get<std::uint8_t>("model"), (std::vector<std::uint8_t>{1, 1, 1}));
  EXPECT_EQ(s.face.get<int>("patch"), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(r.sheets.patches, (std::vector<std::array<int, 2>>{{9, 7}}));
  EXPECT_THROW(opposite_halfedges(s.tris, 5), NotAdmissible);
  Surface apart = surface_of(s);
  split_sheets(apart);
  EXPECT_EQ(apart.points.size(), 9u);
  EXPECT_EQ(topology_of(apart).components, 3);
  // kept once, it is clean
  EXPECT_TRUE(clean(s, {.sheets = CleanOptions::keep}).nothing);
  EXPECT_EQ(s.face.get<int>("patch"), (std::vector<int>{7, 8, 9}));
}

TEST(Clean, SplitSheetsLeavesFlatTriangles) {
  // one of zero area at the border, which clean would drop
  Surface s = surface({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 2, 3}, {2, 1, 3}, {0, 1, 2}});
  const std::vector<Tri> before = s.tris;
  split_sheets(s);
  EXPECT_EQ(s.tris, before);
}

TEST(Clean, SplitSheetsLeavesOrientationAsItIs) {
  Surface s = nested("-+");  // which clean would reverse
  const std::vector<Tri> before = s.tris;
  split_sheets(s);
  EXPECT_EQ(s.tris, before);
}

TEST(Clean, TwoTetrahedraOnOneEdgeStayClosed) {
  std::vector<Vec3> p = tetra_points;
  p.push_back({0, -1, 0});
  p.push_back({0, 0, -1});
  std::vector<Tri> tris = tetra_tris;  // the second one is the first, rotated by 180 degrees about edge 0-1
  for (Tri t : {Tri{0, 4, 1}, Tri{0, 1, 5}, Tri{1, 4, 5}, Tri{4, 0, 5}}) tris.push_back(t);
  Surface s = surface(p, tris);
  EXPECT_EQ(clean(s).nonmanifold_edges, 1);
  EXPECT_EQ(s.points.size(), 8u);
  Topology t = topology_of(s);
  EXPECT_EQ(t.components, 2);
  EXPECT_EQ(t.loops, 0);
  EXPECT_NEAR(volume(s), 2.0 / 6, 1e-15);
}

TEST(Clean, CutsAMoebiusBandAcross) {
  // a strip of five triangles whose ends are joined after half a turn
  const Surface band = surface({{0, 0, 0}, {1, 0, 1}, {2, 1, 0}, {1, 2, 1}, {0, 1, 3}},
                               {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}});
  for (auto sheets : {CleanOptions::pair, CleanOptions::automatic, CleanOptions::keep}) {
    Surface s = band;
    const CleanReport r = clean(s, {.sheets = sheets});
    EXPECT_EQ(r.sheets.flips.triangles, 5);
    EXPECT_EQ(r.sheets.flips.edges, 1);
    EXPECT_EQ(r.sheets.kept, sheets != CleanOptions::pair);
    EXPECT_EQ(s.points.size(), r.sheets.kept ? 5u : 7u);
    if (r.sheets.kept) take_apart(s);
    const Topology t = topology_of(s);
    EXPECT_EQ(t.components, 1);
    EXPECT_EQ(t.loops, 1);
    EXPECT_EQ(t.genus, 0);
    EXPECT_EQ(join_borders(s).size(), 5u);
  }
}

TEST(TakeApart, CountsTheSheetsThatItReverses) {
  for (bool inside_out : {false, true}) {
    Surface s = surface(sphere(80).points, sphere(80).tris);
    const Mesh inner = sphere(80);
    const int n = (int)s.points.size();
    for (const Vec3& p : inner.points) s.points.push_back(0.5 * p);
    for (const auto& [a, b, c] : inner.tris) s.tris.push_back({a + n, b + n, c + n});
    if (inside_out)
      for (int t = 0; t < (int)inner.tris.size(); ++t) std::swap(s.tris[t][0], s.tris[t][1]);
    s = surface(s.points, s.tris);
    EXPECT_EQ(take_apart(s).reversed, inside_out);
  }
}

TEST(Clean, KeepsAStripWithHalfATwistWhoseEndsAreMerged) {
  constexpr int n = 40, m = 3;  // the points of both ends are the same except for rounding
  std::vector<Vec3> points;
  std::vector<Tri> tris;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      const double u = 2 * std::numbers::pi * i / n, r = 3 + (j - 0.5 * m) * std::cos(u / 2);
      points.push_back({r * std::cos(u), r * std::sin(u), (j - 0.5 * m) * std::sin(u / 2)});
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * (m + 1) + j, b = a + m + 1;
      tris.push_back({a, b, b + 1});
      tris.push_back({a, b + 1, a + 1});
    }
  Surface s = surface(points, tris);
  const CleanReport r = clean(s, {.sheets = CleanOptions::automatic});
  EXPECT_EQ(r.welded_near, m + 1);
  EXPECT_EQ(r.sheets.flips.edges, m);
  EXPECT_TRUE(r.sheets.kept);
  EXPECT_EQ((int)s.points.size(), n * (m + 1));
}

TEST(Clean, CutsAKleinBottleAlongAShortLine) {
  // a torus of 30 by 12 quadrangles whose ends are joined mirrored; an immersion in space
  constexpr int n = 30, m = 12;
  std::vector<Vec3> points;
  std::vector<Tri> tris;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * (j + 0.3) / m;
      const double x = std::sin(v), y = std::sin(2 * v), r = 3 + std::cos(u / 2) * x - std::sin(u / 2) * y;
      points.push_back({r * std::cos(u), r * std::sin(u), std::sin(u / 2) * x + std::cos(u / 2) * y});
    }
  auto at = [&](int i, int j) { return i < n ? i * m + j % m : (2 * m - 1 - j) % m; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      tris.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      tris.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  Surface s = surface(points, tris);
  const CleanReport r = clean(s, {.sheets = CleanOptions::automatic});
  EXPECT_EQ(r.sheets.flips.edges, m);
  const std::vector<Tri> oriented = s.tris;
  EXPECT_EQ(clean(s, {.sheets = CleanOptions::automatic}).sheets.flips.edges, m);
  EXPECT_EQ(s.tris, oriented);  // the line stays where it is
  take_apart(s);
  const Topology t = topology_of(s);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.loops, 2);
  EXPECT_EQ(t.genus, 0);
}

TEST(Clean, RefusesWhatHasNoTriangleLeftAndTellsWhy) {
  auto why = [](Surface s, const CleanOptions& options) {
    try {
      clean(s, options);
    } catch (const NotAdmissible& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(why(surface(tetra_points, {{0, 0, 1}}), {}), "no triangle is left of 1: 1 degenerate");
  EXPECT_EQ(why(surface(tetra_points, {}), {}), "the input has no triangle");
  const Surface band = surface({{0, 0, 0}, {1, 0, 1}, {2, 1, 0}, {1, 2, 1}, {0, 1, 3}},
                               {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}});
  EXPECT_EQ(why(band, {.drop_nonorientable = true}), "no triangle is left of 5: 5 not orientable");
}

//  3-------2       triangle 1 = (0, 1, 4) is a cap: 4 lies on the edge 0-1; without it, and with nothing else
//  done,
//   \  0  / \      the surface would have a crack between (0, 1, 2) and the triangles below
//    0-4-1
//     \|/          .
//      5
TEST(Clean, FlipsACapIntoItsNeighbor) {
  Surface s = surface({{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {-1, 2, 0}, {1, 0, 0}, {1, -1, 0}},
                      {{0, 1, 2}, {0, 4, 1}, {0, 5, 4}, {4, 5, 1}, {0, 2, 3}});
  CleanReport r = clean(s);
  EXPECT_EQ(r.degenerate, 1);
  EXPECT_EQ(r.flat, 0);
  EXPECT_EQ(s.tris.size(), 5u);
  EXPECT_DOUBLE_EQ(total_area(s), 2 + 2 + 1);
  for (const Tri& t : s.tris) EXPECT_GT(kappa(s.points[t[0]], s.points[t[1]], s.points[t[2]]), 0.1);
  Topology t = topology_of(s);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.loops, 1);
  EXPECT_EQ(t.genus, 0);
  // both pieces of the neighbor are of its patch
  std::vector<int> patch = s.face.get<int>("patch");
  EXPECT_EQ(std::count(patch.begin(), patch.end(), 10), 2);
  EXPECT_EQ(std::count(patch.begin(), patch.end(), 11), 0);
}

//    up        1 and 2 lie on the edges 0-2 and 1-3: the sheets above and below are divided differently, and
//   / | \      two flat triangles between them share the edge 0-3. Neither can be flipped into a sheet at
//   once
//  0-12--3
//   \ | /
//   down
TEST(Clean, ClosesASlitBetweenPointsInLine) {
  Surface s = surface({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {8, 0, 0}, {4, 5, 0}, {4, -5, 0}},
                      {{0, 1, 4}, {1, 3, 4}, {2, 0, 5}, {3, 2, 5}, {0, 2, 3}, {0, 3, 1}});
  CleanReport r = clean(s);
  EXPECT_EQ(r.degenerate, 2);
  EXPECT_EQ(r.flat, 0);
  EXPECT_DOUBLE_EQ(total_area(s), 40);
  expect_manifold(s);
  EXPECT_EQ(topology_of(s).loops, 1);
}

TEST(Clean, ClosesALongSlit) {
  // n segments above, shifted against those below; all flat triangles share one vertex
  const int n = 40;
  std::vector<Vec3> points;
  std::vector<Tri> tris;
  for (int i = 0; i <= 2 * n; ++i) points.push_back({(double)i, 0, 0});
  points.push_back({(double)n, 2.0 * n, 0});
  points.push_back({(double)n, -2.0 * n, 0});
  std::vector<int> above, below;
  for (int i = 0; i <= 2 * n; ++i) {
    if (i % 2 == 0) above.push_back(i);
    if (i % 2 == 1 || i == 0 || i == 2 * n) below.push_back(i);
  }
  for (std::size_t i = 1; i < above.size(); ++i) tris.push_back({above[i - 1], above[i], 2 * n + 1});
  for (std::size_t i = 1; i < below.size(); ++i) tris.push_back({below[i], below[i - 1], 2 * n + 2});
  std::vector<int> ring = below;
  ring.insert(ring.end(), above.rbegin() + 1, above.rend() - 1);
  for (std::size_t i = 2; i < ring.size(); ++i) tris.push_back({0, ring[i - 1], ring[i]});
  Surface s = surface(points, tris);
  EXPECT_EQ(clean(s).flat, 0);
  expect_manifold(s);
}

TEST(Clean, DropsACapOnTheBorder) {
  Surface s = surface({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, -1, 0}}, {{0, 2, 1}, {0, 3, 2}, {2, 3, 1}});
  CleanReport r = clean(s);
  EXPECT_EQ(r.degenerate, 1);
  EXPECT_EQ(s.tris.size(), 2u);
  expect_manifold(s);
}

//      3           triangle (0, 1, 2) is a needle: 0 and 1 nearly coincide
//    / | \\         .
//   4--01--2
//    \ || /
//      5
TEST(Clean, CollapsesANeedle) {
  const double e = 1e-14;
  Surface s = surface({{0, 0, 0}, {e, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                      {{0, 1, 3}, {1, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}, {1, 5, 2}});
  CleanReport r = clean(s, {.weld = 0});
  EXPECT_EQ(r.degenerate, 1);  // the other one goes with it
  EXPECT_EQ(r.flat, 0);
  EXPECT_EQ(s.tris.size(), 4u);
  EXPECT_EQ(s.points.size(), 5u);
  EXPECT_NEAR(total_area(s), 2, 1e-12);
  expect_manifold(s);
  EXPECT_EQ(topology_of(s).loops, 1);
}

TEST(Clean, WeldsWithinATolerance) {
  std::vector<Vec3> p = tetra_points;
  Surface s = soup(p, tetra_tris);
  std::mt19937 random(1);
  for (Vec3& q : s.points) q.x += 1e-2 * (random() % 1000) / 1000;
  Surface apart = s;
  clean(apart);
  EXPECT_EQ(apart.points.size(), 12u);
  CleanReport r = clean(s, {.weld = 1e-2});
  EXPECT_EQ(r.welded_near, 8);
  EXPECT_EQ(s.points.size(), 4u);
  EXPECT_EQ(topology_of(s).loops, 0);
  EXPECT_TRUE(clean(s, {.weld = 1e-2}).nothing);
}

TEST(Clean, ChainsOfCloseVerticesDoNotRunTogether) {
  std::vector<Vec3> p;
  for (int i = 0; i <= 10; ++i) p.push_back({0.75 * i, 0, 0});
  std::vector<int> same(p.size());
  for (int i = 0; i <= 10; ++i) same[i] = i;
  EXPECT_EQ(merge_near(p, std::vector<char>(p.size(), 1), 1, same), 5);
  EXPECT_EQ(same, (std::vector<int>{0, 0, 2, 2, 4, 4, 6, 6, 8, 8, 10}));
}

TEST(Clean, DropsANonorientableComponentAndNamesIt) {
  Surface s = surface({{0, 0, 0}, {1, 0, 1}, {2, 1, 0}, {1, 2, 1}, {0, 1, 3}},
                      {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}});
  for (Tri t : tetra_tris) s.tris.push_back({t[0] + 5, t[1] + 5, t[2] + 5});
  for (Vec3 p : tetra_points) s.points.push_back(p);
  s.face = {"face", 0, {}};
  CleanReport r;
  clean(s, {.drop_nonorientable = true}, r);
  EXPECT_EQ(s.tris.size(), 4u);
  EXPECT_NEAR(volume(s), 1.0 / 6, 1e-15);
  ASSERT_EQ(r.nonorientable.size(), 1u);
  EXPECT_EQ(r.nonorientable[0], (std::array<int, 2>{0, 5}));
  EXPECT_EQ(r.offending.size(), 5u);
  EXPECT_EQ(r.components, 1);
}

TEST(Clean, KeepsTheLargestComponents) {
  Surface s;
  for (double size : {1.0, 3.0, 2.0}) {
    const int n = (int)s.points.size();
    for (Vec3 p : tetra_points) s.points.push_back(size * p + Vec3{10 * size, 0, 0});
    for (Tri t : tetra_tris) s.tris.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  CleanReport r = clean(s, {.keep_components = 2});
  EXPECT_EQ(r.dropped_components, 1);
  EXPECT_EQ(r.dropped_triangles, 4);
  ASSERT_EQ(s.points.size(), 8u);
  EXPECT_EQ(s.points[0].x, 30);
  EXPECT_EQ(r.offending.size(), 4u);
  EXPECT_TRUE(clean(s, {.keep_components = 2}).nothing);
}

TEST(Clean, FillsHolesOfAtMostThatManyEdges) {
  // a cube without its top: the hole has 4 edges; of the two diagonals one is there already, below it
  Surface s = surface(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{0, 2, 1},
                                                                                                 {0, 3, 2},
                                                                                                 {0, 1, 5},
                                                                                                 {0, 5, 4},
                                                                                                 {1, 2, 6},
                                                                                                 {1, 6, 5},
                                                                                                 {2, 3, 7},
                                                                                                 {2, 7, 6},
                                                                                                 {3, 0, 4},
                                                                                                 {3, 4, 7}});
  Surface open = s;
  EXPECT_TRUE(clean(open, {.fill_holes = 3}).nothing);
  CleanReport r = clean(s, {.fill_holes = 4});
  EXPECT_EQ(r.holes.filled, 1);
  EXPECT_EQ(r.holes.triangles, 2);
  EXPECT_EQ(topology_of(s).loops, 0);
  EXPECT_NEAR(volume(s), 1, 1e-15);
  EXPECT_EQ(s.face.get<int>("patch").size(), 12u);

  Surface lone = surface(tetra_points, {{0, 1, 2}});
  EXPECT_EQ(clean(lone, {.fill_holes = 3}).holes.left, 1);
  // all but one triangle of a tetrahedron; all but two
  for (int n : {3, 2}) {
    Surface t = surface(tetra_points, std::vector<Tri>(tetra_tris.begin(), tetra_tris.begin() + n));
    EXPECT_EQ(clean(t, {.fill_holes = 4}).holes.filled, 1);
    EXPECT_EQ(topology_of(t).loops, 0);
    EXPECT_EQ(t.tris.size(), 4u);
  }
}

/// A fan around a vertex above the origin, its border a star of five points with 2 n corners.
Surface star_cone(int n) {
  std::vector<Vec3> points{{0, 0, 1}};
  std::vector<Tri> tris;
  for (int i = 0; i < 2 * n; ++i) {
    const double angle = std::numbers::pi * i / n, radius = 1 + 0.5 * std::sin(5 * angle);
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    tris.push_back({0, 1 + i, 1 + (i + 1) % (2 * n)});
  }
  return surface(points, tris);
}

TEST(Clean, FillsLongLoopsAndNamesEachCap) {
  for (int n : {20, 501}) {
    Surface s = star_cone(n);
    const double area_of_cone = total_area(s);
    const CleanReport r = clean(s, {.fill_holes = 100000, .cap_patches = true});
    EXPECT_EQ(r.holes.filled, 1);
    EXPECT_EQ(r.holes.triangles, 2 * n - 2);
    EXPECT_EQ(topology_of(s).loops, 0);
    // exactly the star: every triangle of the cap looks down, and they overlap nowhere
    double star = 0, cap = 0;
    for (int i = 0; i < 2 * n; ++i)
      star += cross(Vec2{s.points[1 + i].x, s.points[1 + i].y},
                    Vec2{s.points[1 + (i + 1) % (2 * n)].x, s.points[1 + (i + 1) % (2 * n)].y}) /
              2;
    const std::vector<int>& patch = s.face.get<int>("patch");
    for (std::size_t t = 0; t < s.tris.size(); ++t) {
      const Vec3 twice = area_vector(s.points[s.tris[t][0]], s.points[s.tris[t][1]], s.points[s.tris[t][2]]);
      EXPECT_EQ(patch[t] == r.holes.patches.at(0), t >= std::size_t(2 * n));
      if (t < std::size_t(2 * n)) continue;
      EXPECT_LT(twice.z, 0);
      cap += norm(twice) / 2;
    }
    EXPECT_NEAR(cap, star, 1e-9);
    EXPECT_NEAR(total_area(s), area_of_cone + star, 1e-9);
  }
}

//      2            a tetrahedron whose edge 0-1 has a vertex in its middle on one side only: the hole
//     / \           (0, 1, 4), whose corners are in line, is filled and flipped away
//    0---1
//    0-4-1
//     \|/           .
//      3
TEST(Clean, FillsASlitWithoutATriangleOfNoArea) {
  Surface s = surface(tetra_points, {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  s.points.push_back({0.5, 0, 0});
  const CleanReport r = clean(s, {.fill_holes = 3, .keep_slits = true});
  EXPECT_EQ(r.holes.filled, 1);
  EXPECT_EQ(r.degenerate, 0);
  EXPECT_TRUE(r.offending.empty());
  EXPECT_EQ(s.tris.size(), 6u);
  EXPECT_EQ(topology_of(s).loops, 0);
  EXPECT_NEAR(volume(s), 1.0 / 6, 1e-15);
  for (const Tri& t : s.tris) EXPECT_GT(kappa(s.points[t[0]], s.points[t[1]], s.points[t[2]]), 0.1);
  const std::vector<int>& patch = s.face.get<int>("patch");
  EXPECT_EQ(std::count(patch.begin(), patch.end(), 10), 2);
  EXPECT_TRUE(clean(s, {.fill_holes = 3}).nothing);
}

// points on a grid much coarser than the tolerance needs, so that triangles fall together, lose their area
// and meet in edges of many
TEST(Clean, WeldedCoarselyItIsCleanTheSecondTime) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    Surface s;
    for (int v = 0; v < 40; ++v)
      s.points.push_back({0.25 * (random() % 13), 0.25 * (random() % 5), 0.5 * (random() % 2)});
    for (int t = 0; t < 60; ++t)
      s.tris.push_back({(int)(random() % 40), (int)(random() % 40), (int)(random() % 40)});
    CleanOptions options{.weld = 0.1 * (round % 8), .drop_nonorientable = true};
    options.fill_holes = round % 3 ? 0 : 6;
    options.sheets = round % 5 == 0 ? CleanOptions::keep : CleanOptions::pair;
    try {
      clean(s, options);
    } catch (const NotAdmissible&) {
      continue;  // nothing is left
    }
    const CleanReport again = clean(s, options);
    EXPECT_TRUE(again.nothing) << "round " << round;
  }
}

TEST(Clean, RefusesSizesThatCannotBeMeasured) {
  for (double size : {1e-200, 1e200}) {
    Surface s = surface(tetra_points, tetra_tris);
    for (Vec3& p : s.points) p = size * p;
    EXPECT_THROW(clean(s), NotAdmissible);
  }
  for (double size : {1e-40, 1e40}) {
    Surface s = surface(tetra_points, tetra_tris);
    for (Vec3& p : s.points) p = size * p;
    EXPECT_TRUE(clean(s).nothing);
  }
}

TEST(Clean, AnySoupBecomesAnOrientedManifoldAndStaysIt) {
  // triangles drawn among few points: duplicates, edges of many triangles, pinched vertices in numbers
  int admitted = 0;
  for (int seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::vector<Vec3> p;
    for (int v = 0; v < 9; ++v)  // some twice
      p.push_back(v > 5 && random() % 2 ? p[v - 5] : Vec3{random() * 1e-9, random() * 1e-9, random() * 1e-9});
    std::vector<Tri> tris;
    for (int t = 0; t < 4 + (int)(random() % 12); ++t)
      tris.push_back({(int)(random() % 9), (int)(random() % 9), (int)(random() % 9)});
    Surface s = surface(p, tris);
    CleanOptions options;
    if (seed % 3 == 1) options = {.weld = 1, .drop_nonorientable = true};
    if (seed % 3 == 2) options = {.keep_components = 1, .fill_holes = 6};
    try {
      clean(s, options);
    } catch (const NotAdmissible&) {
      continue;
    }
    ++admitted;
    expect_manifold(s);
    Surface kept = surface(p, tris);
    options.sheets = CleanOptions::keep;
    clean(kept, options);
    EXPECT_TRUE(clean(kept, {.sheets = CleanOptions::keep}).nothing) << "seed " << seed;
    const std::vector<Tri> before = s.tris;
    EXPECT_TRUE(clean(s).nothing) << "seed " << seed;
    EXPECT_EQ(s.tris, before);
  }
  EXPECT_GT(admitted, 150);
}

/// The boundary of unit cubes at integer places; vertices are shared, also where cubes touch.
static Surface cubes(const std::vector<std::array<int, 3>>& places) {
  std::set<std::array<int, 3>> solid(places.begin(), places.end());
  std::map<std::array<int, 3>, int> number;
  std::vector<Vec3> points;
  std::vector<Tri> tris;
  for (const auto& cube : solid)
    for (int axis = 0; axis < 3; ++axis)
      for (int side : {0, 1}) {
        auto next = cube;
        next[axis] += side ? 1 : -1;
        if (solid.count(next)) continue;
        int corner[4];
        const int step[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (int k = 0; k < 4; ++k) {
          auto p = cube;
          p[axis] += side;
          p[(axis + 1) % 3] += step[k][0];
          p[(axis + 2) % 3] += step[k][1];
          const auto [at, is_new] = number.insert({p, (int)points.size()});
          if (is_new) points.push_back({(double)p[0], (double)p[1], (double)p[2]});
          corner[side ? k : 3 - k] = at->second;
        }
        tris.push_back({corner[0], corner[1], corner[2]});
        tris.push_back({corner[0], corner[2], corner[3]});
      }
  return surface(points, tris);
}

TEST(Clean, CubesThatTouchAlongEdgesStayClosed) {
  // a U of five cubes whose ends touch along an edge: both pairs of triangles there are in one fan at one end
  Surface s = cubes({{0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}});
  const CleanReport r = clean(s);
  EXPECT_EQ(r.nonmanifold_edges, 1);
  EXPECT_EQ(r.paired_edges, 1);
  EXPECT_EQ(r.opened_edges, 0);
  expect_manifold(s);
  EXPECT_EQ(topology_of(s).loops, 0);
  EXPECT_EQ(topology_of(s).genus, 0);
  EXPECT_NEAR(volume(s), 5, 1e-12);
  // two cubes are two solids
  Surface two = cubes({{0, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(clean(two).components, 2);
  EXPECT_EQ(topology_of(two).loops, 0);
}

TEST(Clean, RandomCubesStayClosed) {
  for (int seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::array<int, 3>> places;
    for (int i = 0; i < 6 * 6 * 6; ++i)
      if (random() % 10 < 3u + seed % 4) places.push_back({i % 6, i / 6 % 6, i / 36});
    Surface s = cubes(places);
    for (Vec3& p : s.points) p = {p.x - 0.3 * p.y, p.y + 0.2 * p.z, p.z + 0.1 * p.x};
    const CleanReport r = clean(s);
    EXPECT_GT(r.paired_edges, 0);
    EXPECT_EQ(r.opened_edges, 0) << "seed " << seed;
    EXPECT_EQ(r.flipped, 0);
    expect_manifold(s);
    EXPECT_EQ(topology_of(s).loops, 0) << "seed " << seed;
    const std::vector<Tri> before = s.tris;
    EXPECT_TRUE(clean(s).nothing) << "seed " << seed;
    EXPECT_EQ(s.tris, before);
    // what is inside out is reversed and paired again
    Surface inward = cubes(places);
    for (Tri& t : inward.tris) std::swap(t[1], t[2]);
    clean(inward);
    EXPECT_EQ(topology_of(inward).loops, 0);
    EXPECT_NEAR(volume(inward), (double)places.size(), 1e-9);
    EXPECT_TRUE(clean(inward).nothing) << "seed " << seed;
  }
}

/// Two boxes of n x n x n cubes that touch, each with its own triangles there: the same ones in reverse, or
/// along the other diagonals.
static Surface two_boxes(int n, bool same_triangles) {
  Surface whole;
  std::vector<int> patch;
  for (int k : {0, 1}) {
    Surface s = cubes([&] {
      std::vector<std::array<int, 3>> places;
      for (int i = 0; i < n * n * n; ++i) places.push_back({i % n + k * n, i / n % n, i / n / n});
      return places;
    }());
    for (std::size_t t = 0; same_triangles && k && t < s.tris.size(); t += 2) {
      const int a = s.tris[t][0], b = s.tris[t][1], c = s.tris[t][2], d = s.tris[t + 1][2];
      s.tris[t] = {b, c, d};
      s.tris[t + 1] = {b, d, a};
    }
    const int first = (int)whole.points.size();
    whole.points.insert(whole.points.end(), s.points.begin(), s.points.end());
    for (const Tri& t : s.tris) {
      whole.tris.push_back({first + t[0], first + t[1], first + t[2]});
      patch.push_back(k);
    }
  }
  for (Vec3& p : whole.points) p = {0.1 * p.x - 0.03 * p.y, 0.1 * p.y, 0.1 * p.z + 0.01 * p.x};
  whole.face.set("patch", patch);
  return whole;
}

TEST(Clean, SheetsAreKeptWherePairsLeaveBordersOrRegionsAreKnown) {
  const CleanOptions automatic{.sheets = CleanOptions::automatic};
  Surface fins = surface({{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}, {0.5, 0, 1}},
                         {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_TRUE(clean(fins, automatic).sheets.kept);
  Surface touching = cubes({{0, 0, 0}, {1, 1, 0}});
  EXPECT_FALSE(clean(touching, automatic).sheets.kept);
  Surface boxes = two_boxes(2, true), crossed = boxes;
  EXPECT_TRUE(clean(boxes, automatic).sheets.kept);
  // where a third one crosses them, what encloses what is not known
  const Surface third = cubes({{0, 0, 0}});
  const int first = (int)crossed.points.size();
  for (Vec3 p : third.points) crossed.points.push_back(0.17 * p + Vec3{0.05, 0.03, 0.07});
  for (const Tri& t : third.tris) {
    crossed.tris.push_back({first + t[0], first + t[1], first + t[2]});
    crossed.face.get<int>("patch").push_back(2);
  }
  EXPECT_FALSE(clean(crossed, automatic).sheets.kept);
  EXPECT_EQ(topology_of(crossed).loops, 0);
}

TEST(Clean, SolidsThatTouchStayClosedEach) {
  for (bool same : {false, true}) {
    Surface s = two_boxes(3, same);
    const double before = volume(s);
    const CleanReport r = clean(s);
    EXPECT_EQ(r.contacts, 18);
    EXPECT_EQ(r.duplicate, 0);
    EXPECT_EQ(r.opened_edges, 0);
    EXPECT_EQ(r.components, 2);
    expect_manifold(s);
    EXPECT_EQ(topology_of(s).loops, 0);
    EXPECT_NEAR(volume(s), before, 1e-12);
    EXPECT_TRUE(clean(s).nothing);
    // sheets that are kept share the triangles
    Surface kept = two_boxes(3, true);
    EXPECT_EQ(clean(kept, {.sheets = CleanOptions::keep}).duplicate, 18);
  }
}

//  a triangle on an edge inside a valley, seen from the side: to p it ends freely, to q it crosses the slope
//   \ p  /
//    \--x--q
//     \/
TEST(Clean, BitsOfASheetStayJoinedAlsoWhereTheyCrossIt) {
  for (const double y : {6.0, 9.0}) {
    constexpr int n = 12;
    Surface s;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) s.points.push_back({(double)i, (double)j, std::abs(j - 6.0)});
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i, d = a + n + 1;
        s.tris.insert(s.tris.end(), {{a, a + 1, d + 1}, {a, d + 1, d}});
      }
    s.points.push_back({5.5, y, 1});
    s.tris.push_back({5 * (n + 1) + 5, 5 * (n + 1) + 6, (int)s.points.size() - 1});
    s = surface(s.points, s.tris);
    const CleanReport r = clean(s, {.sheets = CleanOptions::automatic});
    EXPECT_TRUE(r.sheets.kept);
    EXPECT_EQ(r.opened_edges, 0);
  }
}

//  a fin of two triangles on an edge of a cube, each there in both orientations: d high
//     q-------p
//     | \_    | d
//   --a---\---b--
TEST(Clean, TinyFinsVanishAndLargeOnesStay) {
  for (const auto& [d, n_tris, dropped] : {std::array{1e-7, 2.0, 4.0}, {0.5, 2.0, 2.0}, {0.5, 1.0, 2.0}}) {
    Surface s = cubes({{0, 0, 0}});
    const Tri t = s.tris[0];
    const Vec3 a = s.points[t[0]], b = s.points[t[1]], up = {-d, -d, -d};
    const int p = (int)s.points.size(), q = p + 1;
    s.points.push_back(b + up);
    s.points.push_back(a + up);
    const std::vector<Tri> fin = {{t[0], t[1], p}, {t[0], p, q}};
    for (int i = 0; i < n_tris; ++i) {
      s.tris.push_back(fin[i]);
      s.tris.push_back({fin[i][1], fin[i][0], fin[i][2]});
    }
    s = surface(s.points, s.tris);
    const CleanReport r = clean(s);
    EXPECT_EQ(r.duplicate, dropped);
    EXPECT_EQ(r.opened_edges, dropped < 2 * n_tris);
    EXPECT_EQ(s.tris.size(), 12 + 2 * n_tris - dropped);
  }
}

//  the two sides of a tiny fin have different diagonals, or only one has a vertex m between b and p
//     q-------p
//     |       m
//   --a-------b--
TEST(Clean, TinyFinsVanishWhateverTheirDiagonals) {
  for (bool middle : {false, true}) {
    constexpr double d = 1e-7;
    Surface s = cubes({{0, 0, 0}});
    const Tri t = s.tris[0];
    const int a = t[0], b = t[1], p = (int)s.points.size(), q = p + 1, m = p + 2;
    const Vec3 up = {-d, -d, -d};
    s.points.insert(s.points.end(), {s.points[b] + 1.1 * up, s.points[a] + up, s.points[b] + 0.5 * up});
    s.tris.insert(s.tris.end(), {{a, b, p}, {a, p, q}});
    if (middle)
      s.tris.insert(s.tris.end(), {{b, a, q}, {b, q, m}, {m, q, p}, {b, m, p}});
    else
      s.tris.insert(s.tris.end(), {{b, a, q}, {b, q, p}});
    s = surface(s.points, s.tris);
    EXPECT_EQ(clean(s, {.sheets = CleanOptions::automatic}).opened_edges, 0);
    EXPECT_EQ(s.tris.size(), 12u);
  }
}

TEST(Clean, SolidsMayShareAFaceAnEdgeOrAVertex) {
  for (const Vec3 shift : {Vec3{0, 1, 0}, Vec3{1, 1, 0}, Vec3{1, 1, 1}}) {
    const bool face = shift.x == 0;
    Surface s = cubes({{0, 0, 0}});
    const int n = (int)s.points.size();
    for (int v = 0; v < n; ++v) s.points.push_back(s.points[v] + shift);
    for (int t = 0; t < 12; ++t) {
      const Tri& c = s.tris[t];
      s.tris.push_back({c[0] + n, c[1] + n, c[2] + n});
    }
    s = surface(s.points, s.tris);
    for (CleanOptions::Sheets how : {CleanOptions::automatic, CleanOptions::pair}) {
      Surface cleaned = s;
      const CleanReport r = clean(cleaned, {.sheets = how});
      EXPECT_EQ(r.opened_edges, 0);
      EXPECT_EQ(r.sheets.kept, face && how == CleanOptions::automatic);
      if (r.sheets.kept) {
        const RegionReport regions = take_apart(cleaned);
        EXPECT_EQ(regions.volume.size(), 3u);
        EXPECT_NEAR(regions.volume[1] + regions.volume[2], 2, 1e-12);
        continue;
      }
      expect_manifold(cleaned);
      EXPECT_EQ(r.components, 2);
      EXPECT_EQ(topology_of(cleaned).loops, 0);
      EXPECT_NEAR(volume(cleaned), 2, 1e-12);
    }
  }
}

TEST(Clean, SlitsOfOneEdgeAreDividedSoThatTheyStayOpen) {
  // each of two cubes is cut along the edge where they touch
  Surface s = cubes({{0, 0, 0}, {1, 1, 0}});
  clean(s, {.sheets = CleanOptions::keep});
  const std::vector<std::array<int, 2>> given(s.tris.size(), {5, 0});
  const std::size_t points = s.points.size();
  const RegionReport r = take_apart(s, given);
  EXPECT_EQ(s.tris.size(), 28u);
  EXPECT_EQ(s.points.size(), points + 2 + 4);  // ends for each of the cubes, middles for each of their sides
  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  EXPECT_EQ(std::count(opposite.begin(), opposite.end(), -1), 8);
  expect_manifold(s);
  EXPECT_EQ(r.label, (std::vector<int>{0, 5, 5}));
  EXPECT_NEAR(volume(s), 2, 1e-12);
}

TEST(Clean, SheetsWithoutAreaAreDropped) {
  // a square, and a tetrahedron whose corners are in one line: none of its edges may flip or collapse
  const std::vector<Vec3> points{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0},
                                 {5, 0, 0}, {6, 0, 0}, {7, 0, 0}, {8, 0, 0}};
  const std::vector<Tri> tris{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 7, 5}, {5, 7, 6}, {6, 7, 4}};
  for (auto sheets : {CleanOptions::pair, CleanOptions::split, CleanOptions::keep}) {
    Surface s = surface(points, tris);
    const CleanReport r = clean(s, {.weld = 0, .sheets = sheets});
    EXPECT_EQ(r.flat, 0);
    EXPECT_EQ(r.degenerate, 4);
    EXPECT_EQ(s.tris.size(), 2u);
  }
}

TEST(Clean, TheMiddleOfADividedSlitIsNoOtherPoint) {
  // as above, and a triangle with a corner in the middle of the edge
  const Surface two = cubes({{0, 0, 0}, {1, 1, 0}});
  std::vector<Vec3> points = two.points;
  std::vector<Tri> tris = two.tris;
  const int n = (int)points.size();
  points.insert(points.end(), {{1, 1, 0.5}, {3, 3, 0.5}, {3, 4, 0.5}});
  tris.push_back({n, n + 1, n + 2});
  Surface s = surface(points, tris);
  clean(s, {.sheets = CleanOptions::keep});
  take_apart(s);
  EXPECT_EQ(s.tris.size(), 29u);
  EXPECT_EQ(std::count(s.points.begin(), s.points.end(), (Vec3{1, 1, 0.5})), 1);
  expect_manifold(s);
}

TEST(Clean, SecondCopiesOfASheetAreDropped) {
  for (bool reversed : {false, true})
    for (bool other : {false, true}) {
      Surface s = cubes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
      std::vector<Tri> top;
      for (std::size_t t = 0; t < s.tris.size(); t += 2) {
        const int a = s.tris[t][0], b = s.tris[t][1], c = s.tris[t][2], d = s.tris[t + 1][2];
        if (s.points[a].z + s.points[b].z + s.points[c].z + s.points[d].z < 4) continue;
        top.push_back(other ? Tri{b, c, d} : Tri{a, b, c});
        top.push_back(other ? Tri{b, d, a} : Tri{a, c, d});
      }
      ASSERT_EQ(top.size(), 8u);
      if (reversed)
        for (Tri& t : top) std::swap(t[1], t[2]);
      std::vector<Tri> tris = s.tris;
      tris.insert(tris.end(), top.begin(), top.end());
      Surface doubled = surface(s.points, tris);
      const CleanReport r = clean(doubled);
      EXPECT_EQ(r.duplicate, 8) << reversed << other;
      EXPECT_EQ(r.contacts, 0);
      EXPECT_EQ(topology_of(doubled).loops, 0);
      EXPECT_EQ(doubled.tris.size(), s.tris.size());
    }
}

TEST(Clean, VerticesOfThreeTrianglesNextToKeptSheetsStay) {
  Surface fan;  // three sheets around an edge, each of three triangles around a vertex
  fan.points = {{0, 0, 0}, {0, 0, 1}};
  for (double angle : {0.0, 2.0, 4.0}) {
    const int v = (int)fan.points.size();
    for (double r : {1.0, 0.3}) fan.points.push_back({r * std::cos(angle), r * std::sin(angle), 0.5});
    fan.tris.insert(fan.tris.end(), {{0, 1, v + 1}, {1, v, v + 1}, {v, 0, v + 1}});
  }
  EXPECT_EQ(clean(fan, {.sheets = CleanOptions::keep}).duplicate, 0);
  EXPECT_EQ(fan.tris.size(), 9u);
}

/// A sphere of rows and columns; the rows at the poles are circles of this radius.
static Surface sphere_with_poles(int rows, int columns, double radius) {
  std::vector<Vec3> points;
  std::vector<Tri> tris;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double theta = std::numbers::pi * i / rows, phi = 2 * std::numbers::pi * j / columns;
      const double r = i == 0 || i == rows ? radius : std::sin(theta);
      points.push_back({r * std::cos(phi), r * std::sin(phi), std::cos(theta)});
    }
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const int a = i * columns + j, b = a + columns, d = i * columns + (j + 1) % columns, c = d + columns;
      tris.push_back({a, b, c});
      tris.push_back({a, c, d});
    }
  return surface(points, tris);
}

TEST(Clean, PolesThatRoundingSpreadsAreOnePoint) {
  for (double radius : {1.2e-16, 1e-15, 1e-14}) {
    Surface s = sphere_with_poles(20, 24, radius);
    const CleanReport r = clean(s);
    EXPECT_EQ(r.welded + r.welded_near, 46) << radius;
    EXPECT_LT(r.tolerance, 1e-13);
    EXPECT_EQ(s.points.size(), 19u * 24 + 2);
    expect_manifold(s);
    EXPECT_EQ(topology_of(s).loops, 0);
    EXPECT_TRUE(clean(s).nothing);
  }
}

TEST(Clean, SeamsThatRoundingOpensAreClosed) {
  Surface s = sphere_with_poles(20, 24, 0);
  for (std::size_t v = 0; v < s.points.size(); ++v)  // the last column ends in a copy of the first
    if (v % 24 == 0) s.points.push_back(s.points[v] + Vec3{0, -2.4e-16, 0});
  for (int i = 0; i < 20; ++i)
    for (int t : {48 * i + 46, 48 * i + 47})
      for (int& v : s.tris[t])
        if (v % 24 == 0) v = 24 * 21 + v / 24;
  EXPECT_EQ(topology_of(surface(s.points, s.tris)).loops, 1);
  const CleanReport r = clean(s);
  EXPECT_GT(r.welded_near, 15);
  EXPECT_EQ(topology_of(s).loops, 0);
}

// a tetrahedron of which one triangle is divided at an edge that the other is not
TEST(Clean, SlitsAreClosed) {
  for (double width : {0.0, 1e-14, 1e-7, 1e-3}) {
    Surface s = surface(tetra_points, tetra_tris);
    const auto [a, b, c] = s.tris[0];
    const Vec3 middle = 0.5 * (s.points[a] + s.points[b]);
    s.points.push_back(middle + width * (s.points[c] - middle));
    s.tris[0] = {a, 4, c};
    s.tris.push_back({4, b, c});
    s = surface(s.points, s.tris);
    const CleanReport r = clean(s);
    EXPECT_EQ(r.holes.slit_vertices, width < 1e-5) << width;
    EXPECT_EQ(topology_of(s).loops, width > 1e-5) << width;
    EXPECT_EQ(r.holes.filled, 0);
    expect_manifold(s);
    EXPECT_TRUE(clean(s).nothing) << width;
  }
}

// the same at all three edges of the triangle, so that slits meet at its corners
TEST(Clean, SlitsThatMeetAreClosed) {
  Surface s = surface(tetra_points, tetra_tris);
  const auto [a, b, c] = s.tris[0];
  for (auto [p, q] : {std::pair{a, b}, {b, c}, {c, a}}) s.points.push_back(0.5 * (s.points[p] + s.points[q]));
  s.tris[0] = {a, 4, 6};
  for (const Tri& t : {Tri{4, b, 5}, Tri{5, c, 6}, Tri{4, 5, 6}}) s.tris.push_back(t);
  s = surface(s.points, s.tris);
  const CleanReport r = clean(s);
  EXPECT_EQ(r.holes.slit_vertices, 3);
  EXPECT_EQ(r.nonmanifold_vertices, 0);
  EXPECT_EQ(s.points.size(), 7u);
  EXPECT_EQ(topology_of(s).loops, 0);
  EXPECT_NEAR(volume(s), 1.0 / 6, 1e-15);
  expect_manifold(s);
}

// a tetrahedron a b c d, open along a-b or, with a needle (n b m), along half of it:
//     a----m----b      above: triangles with c, below: with d; m and n are `width` apart
//     a----n----b
TEST(Clean, EndsOfSlitsAreMerged) {
  enum { a, b, c, d, m, n };
  for (double width : {1e-7, 1e-3})
    for (bool needle : {false, true}) {
      std::vector<Tri> tris{{b, c, d}, {a, d, c}, {a, m, d}, {m, b, d}, {a, c, n}, {n, c, b}};
      if (needle) tris.push_back({n, b, m});
      Surface s = surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {.5, 0, 0}, {.5, width, 0}}, tris);
      EXPECT_EQ(topology_of(s).loops, 1);
      const CleanReport r = clean(s, {.weld = 0});
      const bool closed = width < 1e-5;
      EXPECT_EQ(r.holes.slit_ends, closed) << width;
      EXPECT_EQ(r.degenerate, closed && needle);
      EXPECT_EQ(s.points.size(), closed ? 5u : 6u);
      EXPECT_EQ(topology_of(s).loops, !closed);
      expect_manifold(s);
      EXPECT_TRUE(clean(s, {.weld = 0}).nothing);
    }
}

TEST(Clean, AShortEdgeOfAStraightBorderIsNoSlit) {
  Surface s = surface({{0, 0, 0}, {.5, 0, 0}, {.5 + 1e-7, 0, 0}, {1, 0, 0}, {.5, 1, 0}},
                      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}});
  EXPECT_TRUE(clean(s, {.weld = 0}).nothing);
}

TEST(Clean, ARibbonIsNoSlit) {
  Surface s = surface({{0, 0, 0}, {1, 0, 0}, {1, 1e-7, 0}, {0, 1e-7, 0}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_TRUE(clean(s).nothing);
}

TEST(Clean, DetailIsNotWelded) {
  // holes whose edges are no errors
  Surface holes = sphere_with_poles(20, 24, 1e-6);
  EXPECT_TRUE(clean(holes).nothing);
  // a cube in single precision, a few spacings high: its height is all that it has
  Surface plate = cubes({{0, 0, 0}});
  for (Vec3& p : plate.points) p.z *= 0x1p-21;
  EXPECT_TRUE(clean(plate).nothing);
  // far away all edges are as short as the precision
  Surface far = sphere_with_poles(20, 24, 0.01);
  for (Vec3& p : far.points) p = p + Vec3{1e14, 1e14, 0};
  EXPECT_EQ(clean(far).welded_near, 0);
  // small next to large: a component of 1e-13, whole
  Surface s = surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, tetra_tris);
  for (const Vec3& p : tetra_points) s.points.push_back(Vec3{2, 2, 2} + 1e-14 * p);
  for (Tri t : tetra_tris) s.tris.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  Surface both = surface(s.points, s.tris);
  EXPECT_EQ(clean(both).welded_near, 0);
}

TEST(Clean, ResolvesWhatIsClosedAsItIs) {
  // tetrahedra one within the other, with a common triangle in the middle of both orders: three sheets there
  Surface s = nested("++");
  s.tris.insert(s.tris.end(), {{0, 2, 1}, {0, 1, 2}, {0, 2, 1}});  // and the last one is too many
  s.tris.push_back({0, 1, 2});
  s.face = {"face", s.tris.size(), {}};
  s.face.set("patch", std::vector<int>(s.tris.size(), 1));
  CleanOptions options;
  options.resolve = CleanOptions::outer;
  const CleanReport r = clean(s, options);
  EXPECT_TRUE(r.resolved.closed);
  EXPECT_EQ(s.tris.size(), 4u);
  EXPECT_EQ(r.duplicate, 0);
  expect_manifold(s);
}
