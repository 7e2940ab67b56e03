// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "lib/contract.h"
#include "lib/error.h"
#include "lib/intersect.h"
#include "lib/shape.h"
#include "lib/weld.h"

namespace meshpipe {
namespace {

TEST(check, connectivity_of_sound_meshes) {
  const Connectivity a = connectivity_of(tube(3, 20, false)), b = connectivity_of(torus(0.4, 500));
  EXPECT_TRUE(a.sound());
  EXPECT_EQ(a.loops, 2);
  EXPECT_EQ(a.genus, 0);
  EXPECT_TRUE(b.sound());
  EXPECT_EQ(b.loops, 0);
  EXPECT_EQ(b.genus, 1);
  EXPECT_EQ(b.components, 1);
}

TEST(check, connectivity_finds_every_fault) {
  const Mesh good = sphere(100);
  Mesh turned = good, doubled = good, repeated = good;
  std::swap(turned.tris[7][0], turned.tris[7][1]);
  doubled.tris.push_back(doubled.tris[5]);
  repeated.tris[9][1] = repeated.tris[9][0];
  EXPECT_EQ(connectivity_of(turned).turned, 3);
  EXPECT_EQ(connectivity_of(doubled).nonmanifold, 3);
  EXPECT_EQ(connectivity_of(doubled).first_nonmanifold, (int)good.tris.size());
  EXPECT_EQ(connectivity_of(repeated).first_degenerate, 9);
}

//  0---1       two triangles that touch in vertex 2 only
//   \ /
//    2
//   / \.
//  3---4
TEST(check, connectivity_finds_a_pinched_vertex) {
  const Mesh m{{{0, 2, 0}, {2, 2, 0}, {1, 1, 0}, {0, 0, 0}, {2, 0, 0}}, {{0, 2, 1}, {3, 4, 2}}};
  const Connectivity c = connectivity_of(m);
  EXPECT_EQ(c.pinched, 1);
  EXPECT_EQ(c.first_pinched, 1);
  EXPECT_FALSE(c.sound());
}

TEST(check, quality_of_a_known_mesh) {
  //  3---2    unit square
  //  | / |
  //  0---1
  const Mesh m{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Quality q = quality_of(m, {0.5, 0.5, 0.5, 0.5});
  EXPECT_NEAR(q.min_angle, 45, 1e-12);
  EXPECT_NEAR(q.max_angle, 90, 1e-12);
  EXPECT_NEAR(q.kappa_mean, 4 * 0.5 / (1 + std::sqrt(2)), 1e-12);
  EXPECT_NEAR(q.edge_min, 2, 1e-12);
  EXPECT_NEAR(q.edge_max, 2 * std::sqrt(2), 1e-12);
  EXPECT_NEAR(q.edge_mean, (8 + 2 * std::sqrt(2)) / 5, 1e-12);
  EXPECT_NEAR(quality_of(m, {}).edge_mean, 1, 1e-12);
  EXPECT_EQ(q.kappa_histogram[(int)(50 * q.kappa_mean)], 2);
}

TEST(check, distance_of_concentric_spheres) {
  Mesh a = sphere(2000), b = sphere(3000);
  for (Vec3& p : b.points) p = 1.1 * p;
  const Distance d = distance_between(a, b, 20000);
  const double unit = diagonal(a);
  // from 0.1 between the vertices to what the chords cut off
  EXPECT_NEAR(d.hausdorff, 0.1 / unit, 0.005 / unit);
  EXPECT_NEAR(d.mean, 0.1 / unit, 0.003 / unit);
  EXPECT_LE(d.mean, d.rms);
  EXPECT_LE(d.rms, d.hausdorff);
  EXPECT_EQ(d.boundary, 0);
}

TEST(check, distance_and_its_bound_hold_the_truth) {
  // a spike of height 0.5 between the samples of a flat square
  const Mesh flat{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Mesh spike{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.71, 0.3, 0.5}},
                   {{0, 1, 4}, {1, 2, 4}, {2, 0, 4}, {0, 2, 3}}};
  for (int samples : {1, 10, 1000}) {
    const Distance d = distance_between(flat, spike, samples);
    EXPECT_NEAR(d.to_reference * diagonal(flat), 0.5, 1e-12);
    EXPECT_LE(d.hausdorff, 0.5 / diagonal(flat) + 1e-12);
    EXPECT_GE(d.hausdorff + d.bound, 0.5 / diagonal(flat));
  }
  EXPECT_LT(distance_between(flat, spike, 10000).bound, 0.1 * distance_between(flat, spike, 10).bound);
}

TEST(check, border_distance) {
  Mesh a = tube(3, 40, false), b = a;
  EXPECT_NEAR(distance_between(a, b, 1000).boundary, 0, 1e-15);
  for (Vec3& p : b.points) p.z += 0.25;
  EXPECT_NEAR(distance_between(a, b, 1000).boundary * diagonal(a), 0.25, 1e-12);
  EXPECT_TRUE(std::isinf(distance_between(a, tube(3, 40, true), 1000).boundary));
}

TEST(check, distance_is_the_same_at_any_number_of_threads) {
  const Mesh a = torus(0.4, 3000), b = torus(0.41, 2000);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Distance one = distance_between(a, b, 10000);
  omp_set_num_threads(3);
  const Distance three = distance_between(a, b, 10000);
  omp_set_num_threads(threads);
  EXPECT_EQ(one.hausdorff, three.hausdorff);
  EXPECT_EQ(one.mean, three.mean);
  EXPECT_EQ(one.rms, three.rms);
  EXPECT_EQ(one.bound, three.bound);
}

TEST(check, weld_joins_what_is_at_one_place) {
  Mesh soup;
  const Mesh good = sphere(100);
  for (const Tri& t : good.tris) {
    const int v = (int)soup.points.size();
    for (int x : t) soup.points.push_back(good.points[x]);
    soup.tris.push_back({v, v + 1, v + 2});
  }
  weld(soup);
  EXPECT_EQ(soup.points.size(), good.points.size());
  EXPECT_TRUE(connectivity_of(soup).sound());
}

TEST(contract, lists_are_read_and_refused) {
  const Contract c = parse_contract("topology,kappa=0.25,hausdorff=1e-3");
  EXPECT_TRUE(c.topology);
  EXPECT_FALSE(c.intersections);
  EXPECT_EQ(*c.kappa, 0.25);
  EXPECT_EQ(*c.hausdorff, 1e-3);
  EXPECT_FALSE(c.angle);
  for (const char* bad : {"", "topologie", "kappa", "kappa=", "kappa=x", "kappa=0.1x", "topology=1",
                          "kappa=-1", "topology,", "angle=30 "})
    EXPECT_THROW(parse_contract(bad), BadUsage) << bad;
}

TEST(contract, every_failure_is_named_with_its_place) {
  const Mesh good = sphere(500);
  auto findings = [&](const Mesh& m) {
    Findings f;
    f.mesh = connectivity_of(m);
    f.reference = connectivity_of(good);
    f.quality = quality_of(m, {});
    f.intersections = self_intersections(m);
    f.reference_intersections = 0;
    f.distance = distance_between(good, m, 2000);
    return f;
  };
  const Contract all =
      parse_contract("topology,intersections,patches,kappa=0.1,kappa_mean=0.9,angle=20,hausdorff=0.01");
  EXPECT_TRUE(judge(all, findings(good), good).empty());

  Mesh moved = good, torn = good;
  moved.points[3] = 3.0 * moved.points[3];
  auto failures = judge(all, findings(moved), moved);
  ASSERT_FALSE(failures.empty());
  EXPECT_EQ(failures.back().requirement, "hausdorff");
  torn.tris.erase(torn.tris.begin());
  failures = judge(parse_contract("topology"), findings(torn), torn);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_EQ(failures[0].fact, "boundary loops 1, the reference has 0");

  Findings f = findings(good);
  f.lost_patches = {"inlet"};
  f.intersections = {{4, 9}};
  failures = judge(all, f, good);
  ASSERT_EQ(failures.size(), 2u);
  EXPECT_EQ(failures[0].requirement, "intersections");
  EXPECT_NE(failures[0].fact.find("triangle 9 with triangle 4 at ("), std::string::npos);
  EXPECT_EQ(failures[1].fact, "patch inlet is lost");
}

}  // namespace
}  // namespace meshpipe
