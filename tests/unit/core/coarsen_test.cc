// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/coarsen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lib/core/bvh.h"
#include "lib/core/topology.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

namespace {

std::vector<int> opposite_of(const Mesh& mesh) {
  return opposite_halfedges(mesh.tris, (int)mesh.points.size());
}

/// Euler characteristic of what the vertices of a side span.
int characteristic(const Mesh& mesh, const std::vector<char>& side, char which) {
  const std::vector<int> opposite = opposite_halfedges(mesh.tris, (int)mesh.points.size());
  int chi = 0;
  for (char s : side) chi += s == which;
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] < h) chi -= side[origin(mesh.tris, h)] == which && side[target(mesh.tris, h)] == which;
  for (const Tri& t : mesh.tris) chi += side[t[0]] == which && side[t[1]] == which && side[t[2]] == which;
  return chi;
}

/// Random connected blobs of coarse vertices: the surface is cut along them into the same topology.
void expect_same_cuts(const Mesh& mesh, const Coarse& coarse) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<char> small(coarse.points.size()), large(mesh.points.size());
    const Vec3 middle = coarse.points[random() % coarse.points.size()];
    const double radius = 0.3 + random() % 100 / 80.;
    for (std::size_t v = 0; v < small.size(); ++v)
      small[v] = (norm(coarse.points[v] - middle) < radius) != (random() % 10 == 0);
    for (std::size_t v = 0; v < large.size(); ++v) large[v] = small[coarse.of[v]];
    for (char side : {0, 1})
      EXPECT_EQ(characteristic(coarse, small, side), characteristic(mesh, large, side));
  }
}

}  // namespace

TEST(Coarsen, KeepsTheTopology) {
  for (const Mesh& mesh : {torus(0.4, 3000), tube(6, 40, false)}) {
    const Coarse coarse = coarsen({mesh, opposite_of(mesh)}, (int)mesh.tris.size() / 4, {.turn = 0.45});
    const Topology before = topology_of(mesh), after = topology_of(coarse);
    EXPECT_EQ(after.genus, before.genus);
    EXPECT_EQ(after.loops, before.loops);
    EXPECT_EQ(after.components, 1);
    EXPECT_LT(coarse.tris.size(), mesh.tris.size() / 2);
    EXPECT_NEAR(after.area, before.area, 0.05 * before.area);
    expect_same_cuts(mesh, coarse);
    // each triangle that is left is the image of the one it was
    for (std::size_t t = 0; t < coarse.tris.size(); ++t)
      for (int k = 0; k < 3; ++k) EXPECT_EQ(coarse.tris[t][k], coarse.of[mesh.tris[coarse.face[t]][k]]);
    for (std::size_t v = 0; v < coarse.vertex.size(); ++v) EXPECT_EQ(coarse.of[coarse.vertex[v]], (int)v);
  }
}

TEST(Coarsen, KeepsThinTubes) {
  // eight edges around already: hardly any may go
  const Mesh mesh = tube(10, 8, false);
  const Coarse coarse = coarsen({mesh, opposite_of(mesh)}, 10, {.turn = 0.45});
  EXPECT_GT(total_area(coarse), 0.9 * total_area(mesh));
}

namespace {

//  y       a square of 2 n^2 triangles, with a model edge along x = 1/2
//  |  / | /
//  +---+---+ x
Surface square_with_line(int n) {
  Surface s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) s.points.push_back({(double)i / n, (double)j / n, 0});
  std::vector<std::uint8_t> model;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      s.tris.push_back({a, b, c}), model.push_back(i + 1 == n / 2 ? 2 : 0);
      s.tris.push_back({a, c, d}), model.push_back(i == n / 2 ? 4 : 0);
    }
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.face.set("model", std::move(model));
  return s;
}

double model_length(const Connectivity& c) {
  double length = 0;
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (c.is_model(h)) length += 0.5 * c.length(h);
  return length;
}

}  // namespace

TEST(Coarsen, StaysWithinItsLimits) {
  const Mesh mesh = torus(0.4, 40000);
  constexpr double length = 0.2, deviation = 0.004;
  const Coarse coarse = coarsen({mesh, opposite_of(mesh)}, 0,
                                {.turn = 25 * degree,
                                 .length = length,
                                 .deviation = std::vector<double>(mesh.points.size(), deviation)});
  EXPECT_LT(coarse.tris.size(), mesh.tris.size() / 8);
  EXPECT_EQ(topology_of(coarse).genus, 1);
  for (int h = 0; h < 3 * (int)coarse.tris.size(); ++h) EXPECT_LE(edge_length(coarse, h), length);
  const Bvh tree(coarse);
  for (Vec3 p : mesh.points) EXPECT_LT(tree.nearest(p).distance, 4 * deviation);
  const Coarse exact =
      coarsen({mesh, opposite_of(mesh)}, 0,
              {.turn = 1, .length = 1, .deviation = std::vector<double>(mesh.points.size(), 1e-7)});
  EXPECT_EQ(exact.tris.size(), mesh.tris.size());
}

TEST(Coarsen, KeepsLinesAndFixedVertices) {
  const Surface s = square_with_line(40);
  std::vector<char> fixed(s.points.size(), 0);
  const int stays = 7 * 41 + 11;
  fixed[stays] = 1;
  const std::vector<int> opposite = opposite_of(s);
  const Coarse coarse = coarsen(
      {s, opposite, s.face.get<std::uint8_t>("model")}, 0,
      {.turn = 0.4, .length = 0.3, .deviation = std::vector<double>(s.points.size(), 1e-6), .fixed = fixed});
  EXPECT_LT(coarse.tris.size(), s.tris.size() / 10);
  EXPECT_NEAR(total_area(coarse), 1, 1e-12);
  EXPECT_NEAR(model_length({coarse, opposite_of(coarse), coarse.model}), 1, 1e-12);
  EXPECT_EQ(coarse.vertex[coarse.of[stays]], stays);
}
