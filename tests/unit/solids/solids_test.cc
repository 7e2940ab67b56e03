// SPDX-License-Identifier: BSD-3-Clause
#include "lib/solids/solids.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

TEST(Solids, FindsTheCubesOfABrickWhateverTheOrientation) {
  Mesh mesh = brick({3, 2, 2}, 300);
  for (std::size_t t = 0; t < mesh.tris.size(); t += 3) std::swap(mesh.tris[t][0], mesh.tris[t][1]);
  const Solids solids = find_solids(mesh);
  ASSERT_EQ(solids.count(), 12);
  for (int r = 1; r <= 12; ++r) EXPECT_NEAR(solids.volume[r], 1, 1e-12);
  EXPECT_TRUE(divides_space(solids));
  std::vector<int> triangles(13, 0);
  for (const auto& [a, b] : solids.sides) ++triangles[a], ++triangles[b];
  for (int r = 2; r <= 12; ++r) EXPECT_EQ(triangles[r], triangles[1]);
}

TEST(Solids, PlacesWhatIsNotConnected) {
  Mesh mesh = nested_spheres(3, 3000);
  const Mesh ball = sphere(200);  // another one next to them
  const int first = (int)mesh.points.size();
  for (Vec3 p : ball.points) mesh.points.push_back(0.2 * p + Vec3{1.5, 0.01, 0.02});
  for (Tri t : ball.tris) mesh.tris.push_back({t[0] + first, t[1] + first, t[2] + first});
  const Solids solids = find_solids(mesh);
  ASSERT_EQ(solids.count(), 4);
  const double unit = 4.0 / 3 * 3.14159265;
  EXPECT_NEAR(solids.volume[2], unit / 27, 0.01 * unit);
  EXPECT_NEAR(solids.volume[1], unit * 7 / 27, 0.01 * unit);
  EXPECT_NEAR(solids.volume[3], unit * 19 / 27, 0.03 * unit);
  EXPECT_NEAR(solids.volume[4], unit * 0.008, 0.001 * unit);
  EXPECT_EQ(solids.sides[0], (std::array{1, 2}));
  const std::vector<Vec3> within = points_within(mesh, solids);
  EXPECT_LT(norm(within[2]), 1.0 / 3);
  EXPECT_LT(norm(within[1]), 2.0 / 3);
  EXPECT_GT(norm(within[1]), 0.33);
  EXPECT_LT(norm(within[4] - Vec3{1.5, 0.01, 0.02}), 0.2);
}

TEST(Solids, AFinAndAnOpenSheetEncloseNothing) {
  Mesh mesh = brick({1, 1, 1}, 12);
  const int n = (int)mesh.points.size(), n_tris = (int)mesh.tris.size();
  mesh.points.push_back({-1, 0.4, 0.3});
  mesh.points.push_back({3, 0.3, 0.3});
  mesh.points.push_back({3, 0.5, 0.3});
  mesh.points.push_back({3, 0.3, 0.7});
  const Tri edge = mesh.tris[0];
  mesh.tris.push_back({edge[0], edge[1], n});
  mesh.tris.push_back({n + 1, n + 2, n + 3});
  const Solids solids = find_solids(mesh);
  EXPECT_EQ(solids.count(), 1);
  EXPECT_NEAR(solids.volume[1], 1, 1e-12);
  EXPECT_EQ(solids.sides[n_tris], (std::array{0, 0}));
  EXPECT_EQ(solids.sides[n_tris + 1], (std::array{0, 0}));
  EXPECT_FALSE(divides_space(solids));
}

TEST(Solids, LabelsOfAFileAreCheckedAgainstTheRegions) {
  const Mesh mesh = brick({2, 1, 1}, 20);
  const Solids solids = find_solids(mesh);
  ASSERT_EQ(solids.count(), 2);
  const int name[3] = {-1, 7, 5};
  std::vector<std::array<int, 2>> given;
  for (std::size_t t = 0; t < mesh.tris.size(); ++t) {
    given.push_back({name[solids.sides[t][0]], name[solids.sides[t][1]]});
    if (t % 2) std::swap(given[t][0], given[t][1]);
  }
  EXPECT_EQ(labels_of(solids, given), (std::vector<int>{-1, 7, 5}));
  auto refused = [&](int t, std::array<int, 2> pair) {
    auto wrong = given;
    wrong[t] = pair;
    try {
      labels_of(solids, wrong);
    } catch (const NotAdmissible& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  int outer = 0;
  while (solids.sides[outer][0] != 0 && solids.sides[outer][1] != 0) ++outer;
  EXPECT_NE(refused(outer, {-1, 9}).find("label 9"), std::string::npos);
  EXPECT_NE(refused(outer, {3, 4}).find("-1 or 0 is expected"), std::string::npos);
}

TEST(Solids, PatchesHaveOneRegionOnEitherSide) {
  Surface s = surface_of(brick({2, 1, 1}, 20));
  const Solids solids = find_solids(s);
  std::vector<std::array<int, 2>> added;
  const std::vector<SheetPatch> sheets = sheet_patches(s, solids, {0, 1, 2}, added);
  EXPECT_EQ(added, (std::vector<std::array<int, 2>>{{2, 1}, {3, 1}}));
  double sum = 0;
  for (const RegionMeasure& r : measure_regions(s, sheets)) sum += r.label > 0 ? r.volume : 0;
  EXPECT_NEAR(sum, 2, 1e-12);
}

TEST(Solids, VoronoiDiagramsAreWholeAndDoNotIntersect) {
  auto check = [](const Mesh& mesh, double volume, double off) {
    const Solids solids = find_solids(mesh);
    EXPECT_EQ(solids.count(), 6);
    double sum = 0;
    for (double v : solids.volume) sum += v;
    EXPECT_NEAR(sum, volume, off);
    EXPECT_EQ(self_intersections(mesh).size(), 0u);
  };
  check(voronoi(6, false, 2000, 1), 1, 1e-12);
  check(voronoi(6, true, 2000, 1), 4.19, 0.15);
  for (bool blocks : {true, false}) {
    // a grid of 10 steps has 11 voxels along each side
    check(labeled_image(6, false, blocks, 2000, 1), 1.1 * 1.1 * 1.1, blocks ? 1e-9 : 1e-6);
    check(labeled_image(6, true, blocks, 2000, 1), 4.19, 0.4);
  }
}
