// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/relax/repair.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

// a hexagon whose middle g is a peak
Surface peak(double height = 2) {
  Surface s = drawn_surface({"  e   d  ",  //
                             "         ",  //
                             "f   g   c",  //
                             "         ",  //
                             "  a   b  "},
                            "abg bcg cdg deg efg fag");
  s.points['g' - 'a'].z = height;
  return s;
}

TEST(MissedFeatures, SamplesAreVerticesAndPointsOfBentEdges) {
  const Surface s = peak();
  const Reference reference(s);
  EXPECT_EQ(feature_samples(reference, 1000).size(), 7u);
  // six edges to the peak and six of the rim, each of two pieces or more
  EXPECT_GE(feature_samples(reference, 7).size(), 7u + 6u);
}

// the same without its middle, on the peak's rim
Surface cut_off() {
  return drawn_surface({"  e   d  ",  //
                        "         ",  //
                        "f       c",  //
                        "         ",  //
                        "  a   b  "},
                       "abc acd ade aef");
}

void put_on_rim(Drawn& m, const Surface& peak) {
  for (int t = 0; t < 6; ++t)
    for (int i = 0; i < 2; ++i) {
      const int v = peak.tris[t][i];
      m.s.place[v] = {t, i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, 0.0};
      m.s.normal[v] = m.reference.normal(m.s.place[v]);
      m.s.hold[v] = fixed;
    }
}

TEST(MissedFeatures, APeakThatTheMeshCutsOffIsReachedOnce) {
  const Surface reference = peak();
  Surface flat = cut_off();
  Drawn m(reference, &flat);
  put_on_rim(m, reference);
  Samples samples{feature_samples(m.reference, 1000), {}};
  EXPECT_TRUE(reach_features(m.s, samples, rules::missed, rules::features));
  ASSERT_EQ(m.s.points.size(), 7u);
  EXPECT_LT(norm(m.s.points[6] - Vec3{4, 4, 2}), 1e-9);
  EXPECT_EQ(m.s.hold[6], anchored);
  EXPECT_FALSE(reach_features(m.s, samples, rules::missed, rules::features));
}

// as a wall next to a cap may be nearest to the cap
TEST(MissedFeatures, APeakOfAnotherPatchIsNotReached) {
  Surface reference = peak();
  reference.face.set("patch", std::vector<int>(6, 2));
  Surface flat = cut_off();  // of patch 1
  Drawn m(reference, &flat);
  put_on_rim(m, reference);
  Samples samples{feature_samples(m.reference, 1000), {}};
  EXPECT_FALSE(reach_features(m.s, samples, rules::missed, rules::features));
}

TEST(Faults, NoPlaceOfTheReferenceStaysFartherThanHalfTheSize) {
  for (double height : {1.0, 3.0, 6.0}) {
    const Surface reference = peak(height);
    Surface flat = cut_off();
    Drawn m(reference, &flat);
    put_on_rim(m, reference);
    Samples samples{feature_samples(m.reference, 1000), {}};
    EXPECT_TRUE(remove_faults(m.s, samples).pairs.empty());
    samples.forget();
    const std::vector<double> distance = sample_distances(m.s, samples, 0);
    EXPECT_LT(*std::max_element(distance.begin(), distance.end()), 2) << height;
    EXPECT_EQ(m.s.mesh.live > 4, height > 2) << "what is near enough stays as it is";
  }
}

// at 3.1 degrees the isosceles triangle has kappa 0.105: a leaning one that has less is at fault
TEST(Faults, ANeedleAtACornerIsNoWorseThanTheContractAllows) {
  Mesh mesh;
  const double slope = std::tan(3.1 * std::numbers::pi / 180);
  mesh.points = {{0, 0, 0}, {10, 0, 0}, {9.8, 9.8 * slope, 0}, {20, 0, 0}, {20, 20 * slope, 0}};
  mesh.tris = {{0, 1, 2}, {1, 4, 2}, {1, 3, 4}};
  Surface surface = surface_of(mesh);
  surface.vertex.set("size", std::vector<double>(5, 10));
  Drawn m(surface);
  for (int v = 0; v < 5; ++v) m.s.hold[v] = v == 2 ? slides : fixed;
  Samples samples{feature_samples(m.reference, 1000), {}};
  remove_faults(m.s, samples);
  for (const auto& [a, b, c] : m.s.mesh.tris)
    if (a == 0 || b == 0 || c == 0) {
      EXPECT_GT(kappa(m.s.points[a], m.s.points[b], m.s.points[c]), 0.1);
    }
}

TEST(Faults, AFarPlaceBetweenSamplesIsFound) {
  // a roof, and a mesh that goes across below the middle of its ridge c-d
  const Surface reference = roof(2.63);
  Surface across = reference;
  across.tris = {{0, 1, 2}, {1, 0, 3}};
  Drawn m(reference, &across);
  put_at_corners(m, reference);
  Samples samples{feature_samples(m.reference, 10), {}}, dense{feature_samples(m.reference, 0.5), {}};
  auto most = [](const std::vector<double>& d) { return *std::max_element(d.begin(), d.end()); };
  const double size = 4, far = 2.2;
  EXPECT_LT(most(sample_distances(m.s, samples, 0)), rules::too_far * size);
  EXPECT_NEAR(most(sample_distances(m.s, dense, 0)), far, 0.1);
  EXPECT_TRUE(remove_faults(m.s, samples).pairs.empty());
  dense.forget();
  EXPECT_LT(most(sample_distances(m.s, dense, 0)), rules::too_far * size);
}

}  // namespace
