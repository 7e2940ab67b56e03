// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/intersect.h"

#include <gtest/gtest.h>

#include "lib/core/connectivity.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

bool meet(std::array<Vec3, 3> s, std::array<Vec3, 3> t) {
  const Mesh m{{s[0], s[1], s[2], t[0], t[1], t[2]}, {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(triangles_intersect(m, 0, 1), triangles_intersect(m, 1, 0));
  return triangles_intersect(m, 0, 1);
}

const std::array<Vec3, 3> base{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

TEST(intersect, without_shared_vertices_touching_counts) {
  EXPECT_TRUE(meet(base, {{{1, 1, -1}, {1, 1, 1}, {9, 9, 1}}}));  // pierced
  EXPECT_TRUE(meet(base, {{{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}}));   // touched by a corner
  EXPECT_TRUE(meet(base, {{{4, 0, 0}, {5, 0, 1}, {5, 0, -1}}}));  // corner on corner, not one vertex
  EXPECT_TRUE(meet(base, {{{2, 2, 0}, {3, 3, 1}, {3, 3, -1}}}));  // corner on an edge
  EXPECT_FALSE(meet(base, {{{1, 1, 1e-300}, {1, 1, 1}, {2, 1, 1}}}));
  EXPECT_FALSE(meet(base, {{{3, 3, -1}, {3, 3, 1}, {9, 9, 1}}}));  // beyond the long edge
  EXPECT_FALSE(meet(base, {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}));   // parallel
}

TEST(intersect, ATriangleWithACornerTwiceMeetsNothingThatSharesIt) {
  const Mesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 2, 3}}};
  EXPECT_FALSE(triangles_intersect(m, 0, 1));
  EXPECT_FALSE(triangles_intersect(m, 1, 0));
}

TEST(intersect, coplanar) {
  EXPECT_TRUE(meet(base, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}));  // within
  EXPECT_TRUE(meet(base, {{{-9, -9, 0}, {40, -9, 0}, {-9, 40, 0}}}));
  EXPECT_TRUE(meet(base, {{{2, 2, 0}, {4, 4, 0}, {2, 4, 0}}}));     // corner on an edge
  EXPECT_TRUE(meet(base, {{{-1, 1, 0}, {5, 1, 0}, {5, 1.5, 0}}}));  // across, no corner inside
  EXPECT_FALSE(meet(base, {{{3, 3, 0}, {5, 3, 0}, {3, 5, 0}}}));
  EXPECT_FALSE(meet(base, {{{5, 0, 0}, {6, 0, 0}, {6, 1, 0}}}));  // on the same line
}

//  2---3     two triangles that share vertices only meet in more than those
//  |\  |\.
//  | \ | \.
//  0---1---4
TEST(intersect, with_shared_vertices) {
  Mesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 0, 0}},
         {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}, {0, 1, 2}, {1, 2, 4}, {2, 4, 0}}};
  EXPECT_FALSE(triangles_intersect(m, 0, 1));  // an edge
  EXPECT_FALSE(triangles_intersect(m, 0, 2));  // a vertex
  EXPECT_TRUE(triangles_intersect(m, 0, 3));   // the same triangle
  EXPECT_TRUE(triangles_intersect(m, 0, 5));   // an edge, folded flat onto it
  EXPECT_TRUE(triangles_intersect(m, 1, 4));   // an edge, overlapping
  m.points[3] = {0.2, 0.2, 0};
  EXPECT_TRUE(triangles_intersect(m, 0, 2));  // a vertex, with a corner inside the other
  m.points[3].z = 1e-9;
  EXPECT_FALSE(triangles_intersect(m, 0, 2));
  EXPECT_FALSE(triangles_intersect(m, 0, 1));  // folded, but not flat
}

TEST(intersect, finds_what_crosses_and_nothing_else) {
  for (Mesh m : {sphere(600), torus(0.4, 900), Mesh(cube(600))}) {
    EXPECT_TRUE(self_intersections(m).empty());
    // a copy moved a little crosses the first; every pair the brute search finds is there
    const int n = (int)m.points.size(), f = (int)m.tris.size();
    for (int v = 0; v < n; ++v) m.points.push_back(m.points[v] + Vec3{0.31, 0.17, 0.05});
    for (int t = 0; t < f; ++t) m.tris.push_back({m.tris[t][0] + n, m.tris[t][1] + n, m.tris[t][2] + n});
    std::vector<std::pair<int, int>> all;
    for (int s = 0; s < 2 * f; ++s)
      for (int t = s + 1; t < 2 * f; ++t)
        if (overlap(box_of(m, s), box_of(m, t)) && triangles_intersect(m, s, t)) all.push_back({s, t});
    EXPECT_FALSE(all.empty());
    EXPECT_EQ(self_intersections(m), all);
  }
}

TEST(intersect, triangles_without_area_are_left_out) {
  const Mesh m{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {1, 1, 2}}, {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_TRUE(self_intersections(m).empty());
}

// two spheres through each other, meshed twice: the finer mesh has more pairs, but none that is new
TEST(intersect, new_are_those_where_the_reference_has_none) {
  auto two = [](int n, double apart) {
    Mesh m = sphere(n);
    const int points = (int)m.points.size(), tris = (int)m.tris.size();
    for (int v = 0; v < points; ++v) m.points.push_back(m.points[v] + Vec3{apart, 0, 0});
    for (int t = 0; t < tris; ++t)
      m.tris.push_back({m.tris[t][0] + points, m.tris[t][1] + points, m.tris[t][2] + points});
    return m;
  };
  const Mesh coarse = two(400, 0.6), fine = two(4000, 0.6), closer = two(4000, 0.1), apart = two(400, 3);
  const auto pairs = self_intersections(coarse);
  const Mesh known = contacts(coarse, pairs);
  ASSERT_EQ(known.tris.size(), pairs.size());
  for (const Vec3& p : known.points) EXPECT_NEAR(p.x, 0.3, 0.1);  // the circle where they meet
  const auto more = self_intersections(fine);
  EXPECT_GT(more.size(), pairs.size());
  EXPECT_TRUE(new_intersections(fine, more, known).empty());
  const auto other = self_intersections(closer);
  EXPECT_GT(new_intersections(closer, other, known).size(), other.size() / 2);
  EXPECT_EQ(new_intersections(fine, more, contacts(apart, self_intersections(apart))), more);
}

// a square of n x n squares, and another one that is moved
Mesh sheets(int n, Vec3 move) {
  Mesh m;
  for (int sheet : {0, 1}) {
    const int first = (int)m.points.size();
    for (int i = 0; i <= n * (n + 2); ++i)
      m.points.push_back(Vec3{10.0 * (i / (n + 1)) / n, 10.0 * (i % (n + 1)) / n, 0} + (double)sheet * move);
    for (int i = 0; i < n * (n + 1); ++i) {
      if (i % (n + 1) == n) continue;
      const int a = first + i, b = a + n + 1;
      m.tris.push_back({a, b, b + 1});
      m.tris.push_back({a, b + 1, a + 1});
    }
  }
  return m;
}

double area_of(const Mesh& m) {
  double area = 0;
  for (int t = 0; t < (int)m.tris.size(); ++t) area += norm(area_vector(m, t)) / 2;
  return area;
}

// triangles in one plane overlap: what a finer mesh of them has anywhere in the overlap is not new
TEST(intersect, in_one_plane_they_share_a_polygon) {
  const Mesh coarse = sheets(1, {3, 4, 0}), fine = sheets(20, {3, 4, 0});
  const Mesh known = contacts(coarse, self_intersections(coarse));
  EXPECT_NEAR(area_of(known), 7 * 6, 1e-12);
  const auto pairs = self_intersections(fine);
  EXPECT_FALSE(pairs.empty());
  EXPECT_TRUE(new_intersections(fine, pairs, known).empty());
  const Mesh elsewhere = sheets(20, {-6, 0, 0});
  EXPECT_FALSE(new_intersections(elsewhere, self_intersections(elsewhere), known).empty());
}

// sheets that touch to rounding: a finer mesh may intersect anywhere in the overlap
TEST(intersect, where_a_surface_lies_on_itself_no_intersection_is_new) {
  const Mesh coarse = sheets(1, {3, 4, 1e-7});
  EXPECT_TRUE(self_intersections(coarse).empty());
  const Mesh known = coincidences(coarse, 1e-6, {});
  EXPECT_NEAR(area_of(known), 7 * 6, 1e-6);
  const Mesh fine = sheets(20, {3, 4, 0});
  EXPECT_TRUE(new_intersections(fine, self_intersections(fine), known).empty());
  const Mesh elsewhere = sheets(20, {-6, 0, 0});
  EXPECT_FALSE(new_intersections(elsewhere, self_intersections(elsewhere), known).empty());
  EXPECT_TRUE(coincidences(coarse, 1e-8, {}).tris.empty());
  Mesh tilted = sheets(20, {3, 4, 1});  // neighbors lie side by side
  for (Vec3& p : tilted.points) p = {0.6 * p.x - 0.3 * p.y, p.x + 0.01 * p.z, 0.7 * p.y + p.z};
  EXPECT_TRUE(coincidences(tilted, 1e-6, {}).tris.empty());
  const Mesh ridge{{{0, 0, 0}, {0, 1, 0}, {1, 0.5, 0}, {1, 0.5, 0.08}}, {{1, 0, 2}, {0, 1, 3}}};  // 5 degrees
  EXPECT_TRUE(coincidences(ridge, 1e-6, {}).tris.empty());
}

}  // namespace
}  // namespace meshpipe
