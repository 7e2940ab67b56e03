// SPDX-License-Identifier: BSD-3-Clause
#include "lib/clean.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <tuple>

#include "lib/error.h"
#include "lib/topology.h"
#include "lib/weld.h"

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
  EXPECT_EQ(find_pinched_vertex(s.tris, o, (int)s.points.size()), -1);
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
  for (auto [given, due, turned] :
       {std::tuple{"-", "+", 4}, {"-+", "+-", 8}, {"--", "+-", 4}, {"-+-", "+-+", 12}}) {
    Surface s = nested(given);
    const CleanReport r = clean(s);
    EXPECT_EQ(r.flipped, turned) << given;
    EXPECT_EQ((int)r.culprits.size(), turned) << given;
    const Surface expected = nested(due);
    for (int c = 0; c < (int)s.tris.size() / 4; ++c) {
      auto part = [&](const Surface& whole) {
        return volume(surface(whole.points, {whole.tris.begin() + 4 * c, whole.tris.begin() + 4 * c + 4}));
      };
      EXPECT_GT(part(s) * part(expected), 0) << given << ' ' << c;
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
  s.tris.insert(s.tris.begin() + 1, {{2, 1, 0}, {3, 3, 1}});  // one again, turned; one with a vertex twice
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

TEST(Clean, KeepsSheetsJoinedOnRequest) {
  // the same three sheets on the edge 0-1: two of them of one patch
  Surface s =
      surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  s.face.set<int>("patch", {7, 8, 7});
  const std::vector<Tri> before = s.tris;
  CleanReport r = clean(s, {.keep_sheets = true});
  EXPECT_EQ(r.nonmanifold_edges, 1);
  EXPECT_EQ(r.copies, 0);
  EXPECT_EQ(r.components, 3);
  EXPECT_FALSE(r.nothing);
  EXPECT_EQ(s.tris, before);
  EXPECT_EQ(s.points.size(), 5u);
  EXPECT_EQ(s.face.get<std::uint8_t>("model"), (std::vector<std::uint8_t>{1, 1, 1}));
  EXPECT_EQ(s.face.get<int>("patch"), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(r.sheet_patches, (std::vector<std::array<int, 2>>{{9, 7}}));
  EXPECT_THROW(opposite_halfedges(s.tris, 5), NotAdmissible);
  Mesh apart = sheets_apart(s);
  EXPECT_EQ(apart.points.size(), 9u);
  EXPECT_EQ(topology_of(apart).components, 3);
  // kept once, it is clean
  EXPECT_TRUE(clean(s, {.keep_sheets = true}).nothing);
  EXPECT_EQ(s.face.get<int>("patch"), (std::vector<int>{7, 8, 9}));
}

TEST(Clean, TwoTetrahedraOnOneEdgeStayClosed) {
  std::vector<Vec3> p = tetra_points;
  p.push_back({0, -1, 0});
  p.push_back({0, 0, -1});
  std::vector<Tri> tris = tetra_tris;  // the second one is the first, turned by half a turn round edge 0-1
  for (Tri t : {Tri{0, 4, 1}, Tri{0, 1, 5}, Tri{1, 4, 5}, Tri{4, 0, 5}}) tris.push_back(t);
  Surface s = surface(p, tris);
  EXPECT_EQ(clean(s).nonmanifold_edges, 1);
  EXPECT_EQ(s.points.size(), 8u);
  Topology t = topology_of(s);
  EXPECT_EQ(t.components, 2);
  EXPECT_EQ(t.loops, 0);
  EXPECT_NEAR(volume(s), 2.0 / 6, 1e-15);
}

TEST(Clean, RefusesAMoebiusBand) {
  // a strip of five triangles whose ends are joined after half a turn
  Surface s = surface({{0, 0, 0}, {1, 0, 1}, {2, 1, 0}, {1, 2, 1}, {0, 1, 3}},
                      {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}});
  try {
    clean(s);
    FAIL();
  } catch (const NotAdmissible& e) {
    EXPECT_NE(std::string(e.what()).find("not orientable: triangles"), std::string::npos);
  }
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
TEST(Clean, FlipsACapIntoItsNeighbour) {
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
  // both pieces of the neighbour are of its patch
  std::vector<int> patch = s.face.get<int>("patch");
  EXPECT_EQ(std::count(patch.begin(), patch.end(), 10), 2);
  EXPECT_EQ(std::count(patch.begin(), patch.end(), 11), 0);
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
  CleanReport r = clean(s);
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
  for (Vec3& q : s.points) q.x += 1e-6 * (random() % 1000) / 1000;
  Surface apart = s;
  clean(apart);
  EXPECT_EQ(apart.points.size(), 12u);
  CleanReport r = clean(s, {.weld = 1e-6});
  EXPECT_EQ(r.welded_near, 8);
  EXPECT_EQ(s.points.size(), 4u);
  EXPECT_EQ(topology_of(s).loops, 0);
  EXPECT_TRUE(clean(s, {.weld = 1e-6}).nothing);
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
  Surface refused = s;
  EXPECT_THROW(clean(refused, {}, r), NotAdmissible);
  EXPECT_EQ(r.culprits.size(), 5u);
  EXPECT_EQ(refused.tris, s.tris);
  clean(s, {.drop_nonorientable = true}, r);
  EXPECT_EQ(s.tris.size(), 4u);
  EXPECT_NEAR(volume(s), 1.0 / 6, 1e-15);
  ASSERT_EQ(r.nonorientable.size(), 1u);
  EXPECT_EQ(r.nonorientable[0].triangle, 0);
  EXPECT_EQ(r.nonorientable[0].triangles, 5);
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
  EXPECT_EQ(r.culprits.size(), 4u);
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
  EXPECT_EQ(r.holes_filled, 1);
  EXPECT_EQ(r.hole_triangles, 2);
  EXPECT_EQ(topology_of(s).loops, 0);
  EXPECT_NEAR(volume(s), 1, 1e-15);
  EXPECT_EQ(s.face.get<int>("patch").size(), 12u);

  Surface lone = surface(tetra_points, {{0, 1, 2}});
  EXPECT_EQ(clean(lone, {.fill_holes = 3}).holes_left, 1);
  // all but one triangle of a tetrahedron; all but two
  for (int n : {3, 2}) {
    Surface t = surface(tetra_points, std::vector<Tri>(tetra_tris.begin(), tetra_tris.begin() + n));
    EXPECT_EQ(clean(t, {.fill_holes = 4}).holes_filled, 1);
    EXPECT_EQ(topology_of(t).loops, 0);
    EXPECT_EQ(t.tris.size(), 4u);
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
  const CleanReport r = clean(s, {.fill_holes = 3});
  EXPECT_EQ(r.holes_filled, 1);
  EXPECT_EQ(r.degenerate, 0);
  EXPECT_TRUE(r.culprits.empty());
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
    options.keep_sheets = round % 5 == 0;
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
    options.keep_sheets = true;
    clean(kept, options);
    EXPECT_TRUE(clean(kept, {.keep_sheets = true}).nothing) << "seed " << seed;
    const std::vector<Tri> before = s.tris;
    EXPECT_TRUE(clean(s).nothing) << "seed " << seed;
    EXPECT_EQ(s.tris, before);
  }
  EXPECT_GT(admitted, 150);
}
