// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/core/random.h"
#include "lib/core/surface_walk.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

double distance_to(const Mesh& m, int t, Vec3 p) {
  const Tri& v = m.tris[t];
  const auto w = closest_on_triangle(p, m.points[v[0]], m.points[v[1]], m.points[v[2]]);
  return norm(vector_to(w, m.points[v[0]], m.points[v[1]], m.points[v[2]], p));
}

//        c            the seven regions of the plane round a triangle
//        |\.
//        | \.
//        a--b
TEST(bvh, closest_point_in_every_region) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  using W = std::array<double, 3>;
  EXPECT_EQ(closest_on_triangle({-1, -1, 2}, a, b, c), (W{1, 0, 0}));
  EXPECT_EQ(closest_on_triangle({2, -0.5, 1}, a, b, c), (W{0, 1, 0}));
  EXPECT_EQ(closest_on_triangle({-0.5, 2, 1}, a, b, c), (W{0, 0, 1}));
  EXPECT_EQ(closest_on_triangle({0.25, -1, 1}, a, b, c), (W{0.75, 0.25, 0}));
  EXPECT_EQ(closest_on_triangle({-1, 0.25, 1}, a, b, c), (W{0.75, 0, 0.25}));
  EXPECT_EQ(closest_on_triangle({1, 1, -1}, a, b, c), (W{0, 0.5, 0.5}));
  EXPECT_EQ(closest_on_triangle({0.25, 0.25, 5}, a, b, c), (W{0.5, 0.25, 0.25}));
}

TEST(bvh, triangles_that_are_all_alike_are_found) {
  Mesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<Tri>(100, Tri{0, 1, 2})};
  const Bvh bvh(m);
  int found = 0;
  bvh.overlapping({{0, 0, 0}, {1, 1, 1}}, [&](int) { ++found; });
  EXPECT_EQ(found, 100);
}

TEST(bvh, a_triangle_without_area_is_its_edges) {
  const Vec3 a{0, 0, 0}, b{0, 0, 0}, c{2, 0, 0};
  const auto w = closest_on_triangle({1, 1, 0}, a, b, c);
  EXPECT_DOUBLE_EQ((w[0] * a + w[1] * b + w[2] * c).x, 1);
}

TEST(bvh, nearest_is_that_of_all_triangles) {
  for (const Mesh& m : {torus(0.4, 1500), sphere(20), branching_tree(2, 0, 0.8, 1500, 1)}) {
    const Bvh bvh(m);
    Random random(1);
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = 3.0 * random.in_ball();
      double best = 1e300;
      for (int t = 0; t < (int)m.tris.size(); ++t) best = std::min(best, distance_to(m, t, p));
      const auto hit = bvh.nearest(p);
      EXPECT_DOUBLE_EQ(hit.distance, best);
      EXPECT_DOUBLE_EQ(distance_to(m, hit.place.face, p), best);
      // with the exact bound, a loose one, and one that is wrong
      EXPECT_DOUBLE_EQ(bvh.nearest(p, best).distance, best);
      EXPECT_DOUBLE_EQ(bvh.nearest(p, 2 * best).distance, best);
      EXPECT_DOUBLE_EQ(bvh.nearest(p, 0.5 * best).distance, best);
      // one that is near enough, or the nearest
      const auto some = bvh.nearest(p, 1e300, 1.5 * best);
      EXPECT_LE(some.distance, 1.5 * best);
      EXPECT_DOUBLE_EQ(distance_to(m, some.place.face, p), some.distance);
      EXPECT_DOUBLE_EQ(bvh.nearest(p, 1e300, 0.5 * best).distance, best);
    }
  }
}

TEST(bvh, scale_and_place_of_the_model_do_not_matter) {
  for (double scale : {1e-30, 1e-7, 1e9}) {
    Mesh m = torus(0.4, 300);
    for (Vec3& p : m.points) p = scale * (p + Vec3{1000, 0, -500});
    const Bvh bvh(m);
    Random random(3);
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = scale * ((k % 2 ? 2.0 : 1e6) * random.in_ball() + Vec3{1000, 0, -500});
      double best = 1e300;
      for (int t = 0; t < (int)m.tris.size(); ++t) best = std::min(best, distance_to(m, t, p));
      EXPECT_DOUBLE_EQ(bvh.nearest(p).distance, best);
    }
  }
}

// Coordinates there are 1/256 apart: sums of a third of each corner are not.
TEST(bvh, distances_are_exact_where_coordinates_are_far_apart) {
  constexpr double far = 3e13, apart = 1.0 / 256;
  const Mesh m{{{far, far, far}, {far + 7 * apart, far, far}, {far, far + 7 * apart, far}}, {{0, 1, 2}}};
  const std::vector<int> opposite{-1, -1, -1};
  for (int x = 0; x <= 7; ++x)
    for (int y = 0; x + y <= 7; ++y) {
      const Vec3 p{far + x * apart, far + y * apart, far + apart};
      int face = 0;
      EXPECT_DOUBLE_EQ(Bvh(m).nearest(p).distance, apart);
      EXPECT_DOUBLE_EQ(walk_to(p, m.points, m.tris, opposite, face), apart);
    }
}

//   1---0 p    the corner that is nearest is the first, second and third of its triangles
//    \ / \.
//     2---3
TEST(bvh, triangles_of_the_nearest_corner_are_equally_near) {
  const Vec3 p{0.37, 0.11, -0.2};
  const Vec3 a{0.1, 0.11, -0.2}, b{-0.6, 0.3, 0.1}, c{-0.2, -0.7, 0.3}, d{-0.3, -0.9, 0.7};
  const double distance = norm(a - p);
  for (const auto& [x, y, z] : {std::array{a, b, c}, {b, c, a}, {c, a, b}, {a, c, d}, {c, d, a}, {d, a, c}})
    EXPECT_EQ(norm(vector_to(closest_on_triangle(p, x, y, z), x, y, z, p)), distance);
}

TEST(bvh, meshes_of_any_count) {
  const Mesh all = torus(0.4, 200);
  for (int n = 1; n <= 70; ++n) {
    Mesh m = all;
    m.tris.resize(n);
    const Bvh bvh(m);
    auto order = bvh.order();
    std::sort(order.begin(), order.end());
    for (int t = 0; t < n; ++t) ASSERT_EQ(order[t], t);
    for (int t = 0; t < n; ++t) {
      const Vec3 p = 1.0 / 3 * (m.points[m.tris[t][0]] + m.points[m.tris[t][1]] + m.points[m.tris[t][2]]);
      EXPECT_EQ(bvh.nearest(p).place.face, t);
    }
  }
}

TEST(bvh, follows_a_mesh_that_moves) {
  for (int triangles : {1, 5, 400}) {
    Mesh m = sphere(400);
    m.tris.resize(std::min<std::size_t>(triangles, m.tris.size()));
    Bvh bvh(m);
    Random random(3);
    for (Vec3& p : m.points) p = {3 * p.x + random.uniform(), p.y - 5, p.z * random.uniform()};
    std::swap(m.tris.front()[1], m.tris.back()[2]);
    bvh.refit();
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = 6.0 * random.in_ball();
      double least = 1e300;
      for (int t = 0; t < (int)m.tris.size(); ++t) least = std::min(least, distance_to(m, t, p));
      EXPECT_DOUBLE_EQ(bvh.nearest(p).distance, least);
    }
  }
}

TEST(bvh, boxes_miss_no_triangle) {
  const Mesh m = torus(0.4, 1000);
  const Bvh bvh(m);
  auto order = bvh.order();
  std::sort(order.begin(), order.end());
  for (int t = 0; t < (int)order.size(); ++t) ASSERT_EQ(order[t], t);
  Random random(2);
  for (int k = 0; k < 50; ++k) {
    const Vec3 p = random.in_ball();
    const Box box{p, p + Vec3{0.2, 0.3, 0.1}};
    std::vector<char> seen(m.tris.size(), 0);
    bvh.overlapping(box, [&](int t) { ++seen[t]; });
    for (int t = 0; t < (int)m.tris.size(); ++t) {
      EXPECT_LE(seen[t], 1);
      if (overlap(box, box_of(m, t))) {
        EXPECT_EQ(seen[t], 1);
      }
    }
  }
}

TEST(bvh, cones_miss_no_triangle) {
  const Mesh m = torus(0.4, 1000);
  const Bvh bvh(m);
  Random random(3);
  const double cosine = 0.5, reach = 0.3;
  int inside = 0;
  for (int k = 0; k < 50; ++k) {
    const Vec3 p = random.in_ball(), axis = normalized(random.in_ball());
    std::vector<char> seen(m.tris.size(), 0);
    bvh.in_cone(p, axis, cosine, reach, [&](int t) {
      ++seen[t];
      return reach;
    });
    for (int t = 0; t < (int)m.tris.size(); ++t) {
      EXPECT_LE(seen[t], 1);
      for (int v : m.tris[t]) {
        const Vec3 d = m.points[v] - p;
        if (norm(d) > reach || dot(d, axis) < cosine * norm(d)) continue;
        EXPECT_EQ(seen[t], 1);
        ++inside;
      }
    }
  }
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace meshpipe
