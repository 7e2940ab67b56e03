// SPDX-License-Identifier: BSD-3-Clause
#include "lib/clean.h"

#include <gtest/gtest.h>

#include <random>

#include "lib/error.h"
#include "lib/topology.h"

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
  EXPECT_TRUE(clean(s).nothing());
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
  EXPECT_EQ(r.pinched, 1);
  ASSERT_EQ(s.points.size(), 6u);
  EXPECT_EQ(s.points[5], s.points[0]);
  EXPECT_EQ(s.tris[0], (Tri{0, 2, 1}));
  EXPECT_EQ(s.tris[1], (Tri{5, 3, 4}));
  expect_manifold(s);
  // what it has split it does not weld again
  const std::vector<Tri> before = s.tris;
  EXPECT_TRUE(clean(s).nothing());
  EXPECT_EQ(s.tris, before);
}

TEST(Clean, SplitsThreeSheetsOnOneEdge) {
  Surface s =
      surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  CleanReport r = clean(s);
  EXPECT_EQ(r.nonmanifold_edges, 1);
  EXPECT_EQ(r.pinched, 0);
  EXPECT_EQ(s.points.size(), 9u);
  expect_manifold(s);
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

TEST(Clean, RefusesWhatHasNoTriangleLeft) {
  Surface s = surface(tetra_points, {{0, 0, 1}});
  EXPECT_THROW(clean(s), NotAdmissible);
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
    try {
      clean(s);
    } catch (const NotAdmissible&) {
      continue;
    }
    ++admitted;
    expect_manifold(s);
    const std::vector<Tri> before = s.tris;
    EXPECT_TRUE(clean(s).nothing()) << "seed " << seed;
    EXPECT_EQ(s.tris, before);
  }
  EXPECT_GT(admitted, 150);
}
