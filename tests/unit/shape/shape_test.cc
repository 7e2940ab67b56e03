// SPDX-License-Identifier: BSD-3-Clause
#include "lib/shape/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "lib/core/intersect.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

double volume(const Mesh& m) {
  double v = 0;
  for (const Tri& t : m.tris) v += dot(m.points[t[0]], cross(m.points[t[1]], m.points[t[2]])) / 6;
  return v;
}

void expect_topology(const Mesh& m, int genus, int loops) {
  const Topology t = topology_of(m);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.genus, genus);
  EXPECT_EQ(t.loops, loops);
}

TEST(shape, tubes_are_open_or_closed_by_caps) {
  const Mesh open = tube(10, 40, false), closed = tube(10, 40, true);
  expect_topology(open, 0, 2);
  expect_topology(closed, 0, 0);
  EXPECT_NEAR(volume(closed), 3.14159265 / 4 * 10, 0.05);
}

TEST(shape, formulas_are_oriented_outward_and_of_the_asked_size) {
  const Mesh s = sphere(2000), t = torus(0.4, 3000);
  expect_topology(s, 0, 0);
  expect_topology(t, 1, 0);
  EXPECT_GE(s.tris.size(), 2000u);
  EXPECT_LE(s.tris.size(), 2300u);
  EXPECT_NEAR(t.tris.size(), 3000, 300);
  EXPECT_NEAR(volume(s), 4.18879, 0.03);
  EXPECT_NEAR(volume(t), 2 * 3.14159265 * 3.14159265 * 0.16, 0.05);
}

TEST(shape, cube_has_six_named_sides) {
  const Body c = cube(300);
  expect_topology(c, 0, 0);
  EXPECT_NEAR(volume(c), 1, 1e-12);
  EXPECT_EQ(c.names.size(), 6u);
  for (std::size_t t = 0; t < c.tris.size(); ++t)
    for (int v : c.tris[t]) {
      const double x[3] = {c.points[v].x, c.points[v].y, c.points[v].z};
      EXPECT_EQ(x[c.patch[t] / 2], c.patch[t] % 2);
    }
}

TEST(shape, cad_body_has_full_length_slivers) {
  const Body b = cad_body(3, 2, 64);
  expect_topology(b, 6, 0);
  EXPECT_GT(volume(b), 0);
  EXPECT_EQ(*std::max_element(b.patch.begin(), b.patch.end()) + 1, (int)b.names.size());
  EXPECT_EQ(std::set<std::string>(b.names.begin(), b.names.end()).size(), b.names.size());
  double worst = 1;
  for (const Tri& t : b.tris) worst = std::min(worst, kappa(b.points[t[0]], b.points[t[1]], b.points[t[2]]));
  EXPECT_LT(worst, 0.05);
  EXPECT_GT(worst, 0);
}

TEST(shape, marching_finds_all_of_a_surface_it_may_skip_blocks_of) {
  // two spheres in one grid whose sides are no multiple of a block
  auto f = [](Vec3 p) { return std::min(norm(p - Vec3{-1, 0, 0}), norm(p - Vec3{1, 0, 0})) - 0.7; };
  const Mesh m = march(f, {-1.8, -0.8, -0.8}, {1.8, 0.8, 0.8}, 61);
  const Topology t = topology_of(m);
  EXPECT_EQ(t.components, 2);
  EXPECT_EQ(t.genus, 0);
  EXPECT_EQ(t.loops, 0);
  EXPECT_NEAR(volume(m), 2 * 4.18879 * 0.343, 0.02);
  for (Vec3 p : m.points) EXPECT_NEAR(f(p), 0, 0.02);
}

TEST(shape, genus_surface_has_its_holes) {
  for (int g : {0, 1, 4, 9}) expect_topology(genus_surface(g, 3000), g, 0);
}

TEST(shape, tree_has_its_outlets_cut_flat) {
  const Mesh m = branching_tree(0, 9, 0.8, 6000, 3);
  expect_topology(m, 0, 9);
  EXPECT_NEAR(m.tris.size(), 6000, 60);
  const auto opposite = opposite_halfedges(m.tris, (int)m.points.size());
  for (const auto& loop : boundary_loops(opposite)) {
    Vec3 area, middle;
    for (int h : loop) middle = middle + (1.0 / loop.size()) * m.points[origin(m.tris, h)];
    for (int h : loop)
      area = area + cross(m.points[origin(m.tris, h)] - middle, m.points[target(m.tris, h)] - middle);
    for (int h : loop) EXPECT_NEAR(dot(m.points[origin(m.tris, h)] - middle, normalized(area)), 0, 1e-9);
  }
}

TEST(shape, EndsOfTreesAreRoundAlsoWhereTrianglesAreLarge) {
  for (int outlets : {2, 123, 147}) {
    const Mesh m = branching_tree(0, outlets, 0.8, 25000, 1);
    const auto loops = boundary_loops(opposite_halfedges(m.tris, (int)m.points.size()));
    EXPECT_EQ((int)loops.size(), outlets);
    for (const auto& loop : loops) {
      Vec3 area;
      double length = 0;
      for (int h : loop) {
        const Vec3 p = m.points[origin(m.tris, h)], q = m.points[target(m.tris, h)];
        area = area + 0.5 * cross(p - m.points[origin(m.tris, loop[0])], q - p);
        length += norm(q - p);
      }
      EXPECT_GT(4 * std::numbers::pi * norm(area), 0.9 * length * length) << outlets;
    }
  }
}

TEST(shape, TreesNeitherCrossThemselvesNorFold) {
  for (int outlets : {59, 64, 85, 97}) {
    const Mesh m = branching_tree(0, outlets, 0.8, 25000, 1);
    EXPECT_TRUE(self_intersections(m).empty()) << outlets;
    const std::vector<int> opposite = opposite_halfedges(m.tris, (int)m.points.size());
    for (int h = 0; h < (int)opposite.size(); ++h) {
      if (opposite[h] < 0) continue;
      const Vec3 a = area_vector(m, h / 3), b = area_vector(m, opposite[h] / 3);
      ASSERT_GT(dot(a, b), -0.7 * norm(a) * norm(b)) << outlets;
    }
    EXPECT_NEAR(m.tris.size(), 25000, 60) << outlets;
    expect_topology(m, 0, outlets);
  }
}

TEST(shape, tree_has_the_aspect_asked_for) {
  for (double aspect : {17.0, 28.0}) {
    const Topology t = topology_of(branching_tree(0, 9, 0.8, 8000, 1, aspect));
    EXPECT_EQ(t.loops, 9);
    EXPECT_NEAR(t.eta_cyl, aspect, 0.05 * aspect);
  }
}

TEST(shape, tree_depends_on_its_seed_only) {
  const Mesh a = branching_tree(2, 0, 0.8, 2000, 1), b = branching_tree(2, 0, 0.8, 2000, 1);
  const Mesh c = branching_tree(2, 0, 0.8, 2000, 2);
  EXPECT_EQ(a.tris, b.tris);
  EXPECT_TRUE(a.points == b.points);
  EXPECT_FALSE(a.points == c.points);
}

TEST(shape, slivers_keep_the_surface) {
  Surface s = surface_of(sphere(500));
  s.face.set("patch", std::vector<int>(s.tris.size(), 7));
  const double before = volume(s);
  const std::size_t n = s.tris.size();
  add_slivers(s, 0.3, 1);
  EXPECT_GT(s.tris.size(), n * 5 / 4);
  expect_topology(s, 0, 0);
  EXPECT_NEAR(volume(s), before, 1e-12);
  EXPECT_EQ(s.face.get<int>("patch"), std::vector<int>(s.tris.size(), 7));
}

}  // namespace
}  // namespace meshpipe
