// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/reach_holes.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <string>

#include "lib/core/error.h"
#include "lib/core/random.h"
#include "lib/core/topology.h"
#include "lib/multiscale/multiscale.h"
#include "lib/plan/plan.h"
#include "lib/shape/shape.h"
#include "tests/unit/parts.h"

using namespace meshpipe;

namespace {

TEST(ReachHoles, ThePathOpensAHoleThatLiesInOneSide) {
  const Mesh mesh = branching_tree(0, 5, 0.8, 4000, 1);
  const FilledDisk disk = fill_holes(mesh);
  const auto opposite = opposite_halfedges(mesh.tris, (int)mesh.points.size());
  std::vector<double> field(mesh.points.size(), 1);
  for (int v : disk.rim) field[v] = mesh.points[v].x > 0 ? 1 : -1;
  reach_holes(disk, {disk, opposite}, field);
  for (std::size_t f = 0; f + 1 < disk.fan_begin.size(); ++f) {
    int positive = 0, negative = 0;
    for (int t = disk.fan_begin[f]; t < disk.fan_begin[f + 1]; ++t)
      ++(field[disk.tris[t][0]] > 0 ? positive : negative);
    EXPECT_GT(positive, 0);
    EXPECT_GT(negative, 0);
  }
}

TEST(Multiscale, HalvesOfATreeAreDisksOfLikeSize) {
  Surface s = surface_of(branching_tree(0, 13, 0.8, 12000, 1));
  s.face.set("part", std::vector<int>(s.tris.size(), 0));
  ASSERT_EQ(multiscale_cut(s), 2);
  const auto halves = topology_of_parts(s, s.face.get<int>("part"), 2);
  for (const Topology& t : halves) EXPECT_EQ(t.loops, 1);
  EXPECT_NEAR(halves[0].area / (halves[0].area + halves[1].area), 0.5, 0.05);
  EXPECT_LT(measure_interfaces(s).turning_angle, 25);
}

TEST(Multiscale, AThinRingIsCutIntoTwoFlatRings) {
  Surface s = surface_of(torus(0.2, 4000));
  const int n_parts = partition_to_disks(s);
  ASSERT_EQ(multiscale_cut(s), 2) << n_parts;
  EXPECT_EQ(part_fault(s), "");
  for (const Topology& t : topology_of_parts(s, s.face.get<int>("part"), 2)) {
    EXPECT_EQ(t.loops, 2);
    EXPECT_LT(t.eta_geo, 4);
  }
}

TEST(Multiscale, RandomSurfacesFallIntoAdmissibleParts) {
  constexpr int n = 200;
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);  // surfaces this small only wait for each other's threads
  for (int i = 0; i < n; ++i) {
    Random random(1000 + i);
    Mesh mesh;
    int most = 2;
    std::string what;
    if (i % 3 == 0) {
      const int outlets = 3 + random.below(10);
      mesh = branching_tree(0, outlets, 0.75 + 0.1 * random.uniform(), 1500 + random.below(2500), i);
      what = "tree of " + std::to_string(outlets);
    } else if (i % 3 == 1) {
      const double aspect = 1 + 40 * random.uniform();
      mesh = tube(aspect, 10 + random.below(10), random.below(2));
      what = "tube of " + std::to_string(aspect);
    } else {
      const int genus = 1 + random.below(5);
      mesh = genus_surface(genus, 1500 + random.below(1500));
      most = genus + 2;
      what = "genus " + std::to_string(genus);
    }
    add_noise(mesh, 0.2 * random.uniform(), i);
    Surface s = surface_of(std::move(mesh));
    if (random.below(2)) add_slivers(s, 0.05 * random.uniform(), i);
    partition_to_disks(s);
    const int parts = multiscale_cut(s);
    EXPECT_LE(parts, most) << i << ' ' << what;
    EXPECT_EQ(part_fault(s), "") << i << ' ' << what;
    for (const Topology& t : topology_of_parts(s, s.face.get<int>("part"), parts))
      EXPECT_TRUE(admissible(t)) << i << ' ' << what << ": aspect ratio " << t.eta_geo;
  }
  omp_set_num_threads(threads);
}

}  // namespace
