// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/distance.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "lib/check/check.h"
#include "lib/check/overlay.h"
#include "lib/core/random.h"
#include "lib/core/topology.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

Distance apart(const Mesh& a, const Mesh& b, int samples, double most = 1e300) {
  const std::vector<int> opposite[2] = {opposite_halfedges(a.tris, (int)a.points.size()),
                                        opposite_halfedges(b.tris, (int)b.points.size())};
  return distance_between({a, opposite[0]}, Bvh(a), {b, opposite[1]}, Bvh(b), samples, {}, most);
}

TEST(distance, distance_of_concentric_spheres) {
  Mesh a = sphere(2000), b = sphere(3000);
  for (Vec3& p : b.points) p = 1.1 * p;
  const Distance d = apart(a, b, 20000);
  const double unit = diagonal(a);
  // from 0.1 between the vertices to what the chords cut off
  EXPECT_NEAR(d.hausdorff, 0.1 / unit, 0.005 / unit);
  EXPECT_NEAR(d.mean, 0.1 / unit, 0.003 / unit);
  EXPECT_LE(d.mean, d.rms);
  EXPECT_LE(d.rms, d.hausdorff);
}

TEST(distance, distance_and_its_bound_hold_the_truth) {
  // a spike of height 0.5 between the samples of a flat square
  const Mesh flat{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Mesh spike{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.71, 0.3, 0.5}},
                   {{0, 1, 4}, {1, 2, 4}, {2, 0, 4}, {0, 2, 3}}};
  for (int samples : {1, 10, 1000}) {
    const Distance d = apart(flat, spike, samples);
    EXPECT_NEAR(d.to_reference * diagonal(flat), 0.5, 1e-12);
    EXPECT_LE(d.hausdorff, 0.5 / diagonal(flat) + 1e-12);
    EXPECT_GE(d.hausdorff + d.bound, 0.5 / diagonal(flat));
  }
  EXPECT_LE(apart(flat, spike, 10000).bound, 1e-4);
}

/// The largest distance of dense points of one from the other, by brute force.
double one_sided(const Mesh& from, const Mesh& to) {
  double largest = 0;
  for (const Tri& t : from.tris)
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; i + j <= 8; ++j) {
        const Vec3 p = 0.125 * ((8.0 - i - j) * from.points[t[0]] + (double)i * from.points[t[1]] +
                                (double)j * from.points[t[2]]);
        double nearest = 1e300;
        for (const Tri& u : to.tris) {
          const Vec3 &a = to.points[u[0]], &b = to.points[u[1]], &c = to.points[u[2]];
          const auto w = closest_on_triangle(p, a, b, c);
          nearest = std::min(nearest, norm(w[0] * a + w[1] * b + w[2] * c - p));
        }
        largest = std::max(largest, nearest);
      }
  return largest;
}

// a reference of height 0.4 over a large triangle, and a small one nearer to its tip than that
TEST(distance, small_triangles_of_another_sheet_do_not_judge) {
  Mesh mesh{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  auto add_small = [&](double height) {
    const int n = (int)mesh.points.size();
    for (Vec3 p : {Vec3{1, 1, height}, Vec3{1.1, 1, height}, Vec3{1, 1.1, height}}) mesh.points.push_back(p);
    mesh.tris.push_back({n, n + 1, n + 2});
  };
  const Mesh tip{{{1, 1, 0.4}, {1.02, 1, 0.4}, {1, 1.02, 0.4}}, {{0, 1, 2}}};
  auto worst = [&] {
    const std::vector<int> opposite = opposite_halfedges(mesh.tris, (int)mesh.points.size());
    const std::vector<double> allowed{1, 0.05};
    return distance_from(tip, std::vector<int>{0}, {mesh, opposite}, Bvh(mesh), {10, 10, 4, 0, false},
                         allowed)
        .deviation;
  };
  add_small(0.65);  // 0.25 from the tip, which is 0.4 from the large one
  EXPECT_NEAR(worst().worst, 0.4, 1e-9);
  EXPECT_EQ(worst().triangle, 0);
  mesh.points.resize(3), mesh.tris.resize(1);
  add_small(0.55);  // with the large one more than twice as far as this, the tip is of the small one
  EXPECT_NEAR(worst().worst, 3, 1e-9);
  EXPECT_EQ(worst().triangle, 1);
}

TEST(distance, the_truth_is_between_the_bounds) {
  Random random(1);
  for (double noise : {0.0, 0.01, 0.3}) {
    Mesh a = torus(0.4, 500), b = torus(0.4, 350);
    for (Vec3& p : b.points) p = p + noise * random.in_ball();
    const double truth = std::max(one_sided(a, b), one_sided(b, a)) / diagonal(a);
    for (int samples : {10, 3000}) {
      const Distance d = apart(a, b, samples);
      EXPECT_LE(truth, d.hausdorff + d.bound + 1e-12);
      // the brute points are on a raster of an eighth of a triangle
      EXPECT_GE(d.hausdorff + 1e-12, samples > 10 ? 0.95 * truth : 0);
    }
    const Distance d = apart(a, b, 20000);
    EXPECT_LE(d.bound, std::max(0.051 * d.hausdorff, 1.1e-4)) << noise;
  }
}

TEST(distance, a_distance_below_what_is_asked_is_bounded_by_it) {
  const Mesh a = sphere(500);
  Mesh b = sphere(3000);
  const double found = apart(a, b, 2000).hausdorff;
  const Distance d = apart(a, b, 2000, 1.002 * found);
  EXPECT_LE(d.hausdorff + d.bound, 1.002 * found * (1 + 1e-12));
  EXPECT_GE(d.hausdorff, found * (1 - 1e-12));
}

TEST(distance, of_planes_in_other_triangles_is_bounded_by_rounding) {
  Mesh a = cube(300), b = cube(1000);
  for (Mesh* mesh : {&a, &b})
    for (Vec3& p : mesh->points) p = {0.6 * p.x - 0.8 * p.y + 3, 0.8 * p.x + 0.6 * p.y, p.z};
  const Distance d = apart(a, b, 10000, 1e-9);
  EXPECT_LE(d.hausdorff + d.bound, 1e-9);
}

TEST(distance, a_sheet_over_a_triangle_is_as_high_as_its_highest_part) {
  // a roof of two triangles, its ridge from 0 to 2 half as high as wide, over a triangle in the plane
  Mesh roof{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  roof.points[0].z = roof.points[2].z = 0.5;
  const std::vector<int> opposite = opposite_halfedges(roof.tris, 4);
  const Connectivity surface{roof, opposite};
  const std::array<Vec3, 3> inside{Vec3{-0.3, -0.2, 0}, {0.3, -0.2, 0}, {0, 0.4, 0}};
  EXPECT_NEAR(sheet_height(surface, 0, inside, 1), 0.5, 1e-3);
  EXPECT_NEAR(overlay_height(roof, Bvh(roof), inside, 1), 0.5, 1e-3);
  EXPECT_GT(sheet_height(surface, 0, inside, 0.4), 1e300) << "higher than asked for";
  const std::array<Vec3, 3> under_one{Vec3{0.3, -0.4, 0}, {0.5, -0.4, 0}, {0.4, -0.3, 0}};
  EXPECT_NEAR(sheet_height(surface, 0, under_one, 0.48), 0.325, 1e-3) << "of the plane above it";
  EXPECT_GT(sheet_height(surface, 1, under_one, 1), 1e300) << "the wrong one to start from";
  const std::array<Vec3, 3> reversed{inside[0], inside[2], inside[1]};
  EXPECT_GT(sheet_height(surface, 0, reversed, 1), 1e300);
  const std::array<Vec3, 3> beyond{Vec3{-0.3, -0.2, 0}, {1.3, -0.2, 0}, {0, 0.4, 0}};
  EXPECT_GT(sheet_height(surface, 0, beyond, 1), 1e300) << "past the border";
}

TEST(distance, mean_of_a_slope) {
  //  3---2   a square and the same rotated up about 0-3: distance from it z / sqrt(1 + 1/4), mean over y too
  //  | / |
  //  0---1
  const Mesh flat{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  Mesh slope = flat;
  slope.points[1].z = slope.points[2].z = 1e-3;
  const Distance d = apart(flat, slope, 5000);
  EXPECT_NEAR(d.mean * diagonal(flat), 0.5e-3, 5e-6);
  EXPECT_NEAR(d.rms * diagonal(flat), 1e-3 / std::sqrt(3.0), 5e-6);
}

TEST(distance, curves) {
  auto border = [](const Mesh& m) {
    const Soundness c = soundness_of(m);
    Mesh curves;
    add_segments(curves, m, [&](int h) { return c.opposite[h] < 0; });
    return curves;
  };
  Mesh a = tube(3, 40, false), b = a;
  EXPECT_NEAR(curve_distance(border(a), border(b)), 0, 1e-15);
  for (Vec3& p : b.points) p.z += 0.25;
  EXPECT_NEAR(curve_distance(border(a), border(b)), 0.25, 1e-12);
  EXPECT_TRUE(std::isinf(curve_distance(border(a), border(tube(3, 40, true)))));
  EXPECT_EQ(curve_distance(border(sphere(50)), border(sphere(60))), 0);
}

TEST(distance, distance_is_the_same_at_any_number_of_threads) {
  const Mesh a = torus(0.4, 3000), b = torus(0.41, 2000);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Distance one = apart(a, b, 10000);
  omp_set_num_threads(3);
  const Distance three = apart(a, b, 10000);
  omp_set_num_threads(threads);
  EXPECT_EQ(one.hausdorff, three.hausdorff);
  EXPECT_EQ(one.mean, three.mean);
  EXPECT_EQ(one.rms, three.rms);
  EXPECT_EQ(one.bound, three.bound);
}

}  // namespace
}  // namespace meshpipe
