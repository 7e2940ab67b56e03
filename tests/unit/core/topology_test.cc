// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/topology.h"

#include <gtest/gtest.h>

#include <numbers>

#include "formats/stream/part_table.h"
#include "lib/core/error.h"

using namespace meshpipe;

//  6--7--8      plane_grid(2, 2): two triangles a square, the diagonal from lower left to upper right
//  |/ |/ |
//  3--4--5
//  |/ |/ |
//  0--1--2
static Mesh plane_grid(int nx, int ny) {
  Mesh m;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) m.points.push_back({(double)i, (double)j, 0});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      int a = j * (nx + 1) + i, b = a + 1, d = a + nx + 1, c = d + 1;
      m.tris.push_back({a, b, c});
      m.tris.push_back({a, c, d});
    }
  return m;
}

// nu x nv squares on a torus (both ways round) or on an open cylinder of radius 1 and this height
static Mesh wrapped(int nu, int nv, bool torus, double height) {
  Mesh m;
  int rows = torus ? nv : nv + 1;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < nu; ++i) {
      double a = 2 * std::numbers::pi * i / nu, b = 2 * std::numbers::pi * j / nv;
      if (torus)
        m.points.push_back({(3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b)});
      else
        m.points.push_back({std::cos(a), std::sin(a), height * j / nv});
    }
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      int i1 = (i + 1) % nu, j1 = (j + 1) % rows;
      int a = j * nu + i, b = j * nu + i1, c = j1 * nu + i1, d = j1 * nu + i;
      m.tris.push_back({a, b, c});
      m.tris.push_back({a, c, d});
    }
  return m;
}

TEST(Topology, OppositeIsAnInvolutionBetweenReversedEdges) {
  Mesh m = wrapped(7, 5, false, 1);
  auto o = opposite_halfedges(m.tris, (int)m.points.size());
  int border = 0;
  for (int h = 0; h < (int)o.size(); ++h) {
    if (o[h] < 0) {
      ++border;
      continue;
    }
    EXPECT_EQ(o[o[h]], h);
    EXPECT_EQ(origin(m.tris, h), target(m.tris, o[h]));
    EXPECT_EQ(target(m.tris, h), origin(m.tris, o[h]));
  }
  EXPECT_EQ(border, 14);
}

TEST(Topology, OppositeOfAFanOfManyTrianglesAtVertexZero) {
  Mesh m;
  const int n = 1000;
  m.points.resize(n + 1);
  for (int i = 0; i < n; ++i) m.tris.push_back({0, 1 + i, 1 + (i + 1) % n});
  auto o = opposite_halfedges(m.tris, n + 1);
  for (int i = 0; i < n; ++i) EXPECT_EQ(o[3 * i + 2], 3 * ((i + 1) % n));
  EXPECT_EQ(find_pinched_vertex(m.tris, o, n + 1), -1);
}

TEST(Topology, RefusesWhatIsNoOrientedManifoldAndNamesIt) {
  auto message = [](std::vector<Tri> tris) {
    try {
      opposite_halfedges(tris, 5);
    } catch (const NotAdmissible& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(message({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}).find("edge 0-1 of triangle 0 has 3 triangles"),
            std::string::npos);
  EXPECT_NE(message({{0, 1, 2}, {0, 1, 3}}).find("edge 0-1 runs the same way in triangles 0 and 1"),
            std::string::npos);
  EXPECT_NE(message({{0, 1, 2}, {3, 4, 3}}).find("triangle 1 has vertex 3 twice"), std::string::npos);
}

TEST(Topology, LargeMeshesAreMatchedAsSmallOnesAre) {
  // in ranges of vertices, on several threads: a grid of 40,000 triangles with two faults
  constexpr int n = 142;
  std::vector<Tri> tris;
  for (int j = 0; j < n - 1; ++j)
    for (int i = 0; i < n - 1; ++i) {
      const int v = n * j + i;
      tris.push_back({v, v + 1, v + n});
      tris.push_back({v + n + 1, v + n, v + 1});
    }
  const std::vector<int> opposite = opposite_halfedges(tris, n * n);
  int border = 0;
  for (int h = 0; h < (int)opposite.size(); ++h) {
    const int o = opposite[h];
    border += o < 0;
    if (o < 0) continue;
    EXPECT_EQ(opposite[o], h);
    EXPECT_EQ(origin(tris, o), target(tris, h));
  }
  EXPECT_EQ(border, 4 * (n - 1));
  auto message = [&] {
    try {
      opposite_halfedges(tris, n * n);
    } catch (const NotAdmissible& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  std::swap(tris[39000][0], tris[39000][1]);
  std::swap(tris[300][0], tris[300][1]);
  EXPECT_NE(message().find("and 300;"), std::string::npos) << message();
  tris[39500][2] = tris[39500][0];
  EXPECT_NE(message().find("triangle 39500 "), std::string::npos) << message();
}

TEST(Topology, PartsHaveOppositesOfTheirOwn) {
  Mesh m = plane_grid(2, 1);
  auto o = opposite_halfedges(m.tris, 6);
  std::vector<int> label{0, 0, 1, 1}, component;
  EXPECT_EQ(components(o, component), 1);
  const auto parts = split_by_label(m, label, 2);
  const auto within = opposite_of_parts(parts, {m, o}, label);
  for (int p : {0, 1}) EXPECT_EQ(within[p], opposite_halfedges(parts[p].tris, (int)parts[p].points.size()));
}

//  3--4--5      counter-clockwise, from the smallest half-edge (0: 0 to 1)
//  |/ |/ |
//  0--1--2
TEST(Topology, BoundaryLoopHasItsTrianglesOnTheLeft) {
  Mesh m = plane_grid(2, 1);
  auto loops = boundary_loops(opposite_halfedges(m.tris, 6));
  ASSERT_EQ(loops.size(), 1u);
  std::vector<int> v;
  for (int h : loops[0]) v.push_back(origin(m.tris, h));
  EXPECT_EQ(v, (std::vector<int>{0, 1, 2, 5, 4, 3}));
}

//  1---2          the bow-tie's knot is vertex 0
//   \ /
//    0
//   / \            .
//  3---4
TEST(Topology, FindsThePinchedVertex) {
  Mesh m{{{0, 0, 0}, {-1, 1, 0}, {1, 1, 0}, {-1, -1, 0}, {1, -1, 0}}, {{0, 2, 1}, {0, 3, 4}}};
  EXPECT_EQ(find_pinched_vertex(m.tris, opposite_halfedges(m.tris, 5), 5), 0);
  EXPECT_THROW(topology_of(m), NotAdmissible);
  Mesh g = plane_grid(3, 3);
  EXPECT_EQ(find_pinched_vertex(g.tris, opposite_halfedges(g.tris, 16), 16), -1);
}

TEST(Topology, GenusAndLoopsOfKnownSurfaces) {
  Topology t = topology_of(wrapped(8, 6, true, 0));
  EXPECT_EQ(t.genus, 1);
  EXPECT_EQ(t.loops, 0);
  EXPECT_EQ(t.vertices - t.edges + t.faces, 0);
  EXPECT_EQ(t.eta_geo, 0);
  EXPECT_FALSE(admissible(t));

  t = topology_of(plane_grid(4, 4));
  EXPECT_EQ(t.genus, 0);
  EXPECT_EQ(t.loops, 1);
  EXPECT_DOUBLE_EQ(t.area, 16);
  EXPECT_DOUBLE_EQ(t.longest_loop, 16);
  EXPECT_DOUBLE_EQ(t.eta_cyl, std::numbers::pi / 16);
  EXPECT_DOUBLE_EQ(t.eta_geo, std::numbers::pi / 8);  // two edges deep
  EXPECT_NEAR(t.eta_box, 1, 1e-12);
  EXPECT_TRUE(admissible(t));

  // a torus with one square taken out, and a vertex that no triangle uses
  Mesh m = wrapped(8, 6, true, 0);
  m.tris.erase(m.tris.begin(), m.tris.begin() + 2);
  m.points.push_back({9, 9, 9});
  t = topology_of(m);
  EXPECT_EQ(t.genus, 1);
  EXPECT_EQ(t.loops, 1);
  EXPECT_EQ(t.vertices, 48);
}

TEST(Topology, AspectRatioOfATubeIsHeightOverDiameter) {
  Topology t = topology_of(wrapped(64, 100, false, 10));  // height 10, diameter 2
  EXPECT_EQ(t.loops, 2);
  EXPECT_NEAR(t.eta_cyl, 5, 0.01);
  EXPECT_NEAR(t.eta_geo, 5, 0.01);
  EXPECT_NEAR(t.eta_box, 5, 0.01);
  EXPECT_FALSE(admissible(t));
  EXPECT_TRUE(admissible(t, 5.1));
}

TEST(Topology, TableOfPartsHasARowAPart) {
  Surface s = surface_of(wrapped(16, 8, false, 4));
  std::vector<int> part;  // the lower and the upper half
  for (int t = 0; t < (int)s.tris.size(); ++t) part.push_back(t < (int)s.tris.size() / 2 ? 0 : 1);
  s.face.set("part", part);
  Table table = part_table(s, 2);
  EXPECT_EQ(table.rows, 2u);
  EXPECT_EQ(table.get<int>("genus"), (std::vector<int>{0, 0}));
  EXPECT_EQ(table.get<int>("loops"), (std::vector<int>{2, 2}));
  EXPECT_EQ(table.get<int>("faces"), (std::vector<int>{128, 128}));
  EXPECT_NEAR(table.get<double>("eta_geo")[1], 1, 0.05);

  // known neighbors make no difference
  const auto opposite = opposite_halfedges(s.tris, (int)s.points.size());
  const auto known = topology_of_parts({s, opposite}, part, 2);
  for (const char* column : {"area", "eta_cyl", "eta_box", "eta_geo"})
    EXPECT_EQ(part_table(known).get<double>(column), table.get<double>(column)) << column;

  // parts that meet themselves at a vertex are refused, the first one named, with the surface's own number
  std::fill(part.begin(), part.end(), 0);
  part[0] = part[35] = 1;  // triangles (0, 1, 17) and (17, 34, 33) share vertex 17 only, as do the rest
  ASSERT_EQ(s.tris[0][2], 17);
  try {
    topology_of_parts(s, part, 2);
    FAIL();
  } catch (const NotAdmissible& e) {
    EXPECT_NE(std::string(e.what()).find("part 0: vertex 17"), std::string::npos) << e.what();
  }
}
