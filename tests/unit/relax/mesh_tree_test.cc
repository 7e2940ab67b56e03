// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/mesh_tree.h"

#include <gtest/gtest.h>

#include "lib/core/intersect.h"
#include "lib/relax/operations.h"
#include "lib/relax/repair.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

// a strip of ten squares along x, and one above it
Surface two_strips() {
  Mesh m;
  for (int sheet = 0; sheet < 2; ++sheet)
    for (int i = 0; i <= 10; ++i)
      for (double y : {0.0, 1.0}) m.points.push_back({(double)i, y, (double)sheet});
  for (int sheet = 0; sheet < 2; ++sheet)
    for (int i = 0; i < 10; ++i) {
      const int a = 22 * sheet + 2 * i;
      m.tris.push_back({a, a + 2, a + 1});
      m.tris.push_back({a + 1, a + 2, a + 3});
    }
  Surface s = surface_of(m);
  s.vertex.set("size", std::vector<double>(m.points.size(), 1));
  return s;
}

TEST(MeshTree, IntersectionsAreThoseOfASearchFromScratch) {
  Drawn m(two_strips());
  MeshTree search;
  IntersectingPairs intersecting;
  auto expect = [&](bool some) {
    renew(intersecting, m.s, search);
    EXPECT_EQ(intersecting.pairs, self_intersections({m.s.points, m.s.mesh.tris}));
    EXPECT_EQ(!intersecting.pairs.empty(), some);
  };
  auto lower = [&](int v, double z) {
    m.s.points[v].z = z;
    mark_changed(m.s, v);
  };
  expect(false);
  lower(22 + 6, -1);  // through the strip below
  expect(true);
  lower(14, 2);  // far from there, in the strip below
  expect(true);
  flip_edge(m.s, 1);
  lower(22 + 6, 1);  // back
  expect(true);
  lower(14, 0);
  expect(false);
  for (int i = 0; i < 22; ++i) lower(22 + i, -1);  // all of it
  expect(false);
  lower(3, -2);
  expect(true);
}

TEST(MeshTree, FindsTheNearestPointOfAComponent) {
  Drawn m(two_strips());
  const Vec3 p{4.6, 0.4, 0.9};  // next to the strip above
  MeshTree search;
  search.renew(m.s);
  EXPECT_NEAR(search.nearest(p, 0, 1e300, 0).distance, 0.1, 1e-12);
  m.reference.component = std::vector<int>(40, 0);
  std::fill(m.reference.component.begin() + 20, m.reference.component.end(), 1);
  search.forget();
  search.renew(m.s);
  EXPECT_NEAR(search.nearest(p, 1, 1e300, 0).distance, 0.1, 1e-12);
  const Bvh::Hit hit = search.nearest(p, 0, 1e-3, 0);  // too small a bound
  EXPECT_NEAR(hit.distance, 0.9, 1e-12);
  EXPECT_LT(hit.place.face, 20);
  ASSERT_TRUE(split_edge(m.s, 3 * hit.place.face));  // what is added is found, too
  search.renew(m.s);
  EXPECT_NEAR(search.nearest(p, 0, 1e300, 0).distance, 0.9, 1e-12);
}

// the mesh of the strip above has gone up by two: what it misses is as near to the mesh of the strip below
TEST(MeshTree, SamplesAreMeasuredByTheMeshOfTheirComponent) {
  for (const bool apart : {false, true}) {
    Drawn m(two_strips());
    if (apart) {
      m.reference.component = std::vector<int>(40, 0);
      std::fill(m.reference.component.begin() + 20, m.reference.component.end(), 1);
    }
    for (int v = 22; v < 44; ++v) m.s.points[v].z = 3, mark_changed(m.s, v);
    Samples samples{feature_samples(m.reference, 100), {}};
    const std::vector<double> distance = sample_distances(m.s, samples, 0);
    for (std::size_t i = 0; i < distance.size(); ++i)
      EXPECT_NEAR(distance[i], samples.list[i].place.face < 20 ? 0 : apart ? 2 : 1, 1e-12);
  }
}

TEST(MeshTree, KnowsWhatHasChanged) {
  Drawn m(two_strips());
  const int before = m.s.clocks.now;
  mark_changed(m.s, 0);
  EXPECT_TRUE(changed_since(m.s, 0, before));
  EXPECT_FALSE(changed_since(m.s, 0, m.s.clocks.now));
  EXPECT_FALSE(changed_since(m.s, 1, before));
}

TEST(Samples, DistancesOfTrianglesThatHaveGoneAreForgotten) {
  Drawn m(two_strips());
  Samples samples{{{{0, 1, 0, 0}}, {{12, 1, 0, 0}}}, {}};  // at vertices 0 and 12
  EXPECT_EQ(sample_distances(m.s, samples, 1.5), (std::vector<double>{0, 0}));
  m.s.mesh.collapse(3 * samples.list[1].near, m.s.mesh.from(3 * samples.list[1].near));
  for (int v = 8; v < 18; ++v) {
    m.s.points[v].z = -4;
    mark_changed(m.s, v);
  }
  const std::vector<double> distance = sample_distances(m.s, samples, 1.5);
  EXPECT_EQ(distance[0], 0);
  EXPECT_GT(distance[1], 0.9);  // the other strip is one away
}

}  // namespace
