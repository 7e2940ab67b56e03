// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/coarsen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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
    const Coarse coarse = coarsen({mesh, opposite_of(mesh)}, (int)mesh.tris.size() / 4, 0.45);
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
  const Coarse coarse = coarsen({mesh, opposite_of(mesh)}, 10, 0.45);
  EXPECT_GT(total_area(coarse), 0.9 * total_area(mesh));
}
