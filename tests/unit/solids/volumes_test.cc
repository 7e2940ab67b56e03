// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/core/connectivity.h"
#include "lib/shape/shape.h"
#include "lib/solids/solids.h"

using namespace meshpipe;

namespace {

Compliance all_alike(const Mesh& mesh, double farthest) {
  return {std::vector<double>(mesh.points.size(), 1), std::vector<double>(mesh.points.size(), farthest)};
}

TEST(Volumes, AreMetWhereRegionsShareSheets) {
  Mesh mesh = brick({3, 2, 1}, 600);
  const Solids solids = find_solids(mesh);
  const std::vector<double> volume{0, 1.02, 0.97, 1, 1.01, 0.99, 1.005};
  EXPECT_LT(match_volumes(mesh, solids.sides, volume, all_alike(mesh, 1)), 1e-6);
  const Solids after = find_solids(mesh);
  for (int r = 1; r <= 6; ++r) EXPECT_NEAR(after.volume[r], volume[r], 1e-6);
}

TEST(Volumes, LeaveVerticesThatStayOrHaveMovedFarEnough) {
  Mesh mesh = nested_spheres(2, 500);
  const Solids solids = find_solids(mesh);
  std::vector<double> volume = solids.volume;
  for (double& v : volume) v *= 1.1;
  Compliance c = all_alike(mesh, 1e-3);
  c.share[7] = 0;
  const Mesh before = mesh;
  EXPECT_GT(match_volumes(mesh, solids.sides, volume, c), 0.05);
  EXPECT_EQ(mesh.points[7], before.points[7]);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    EXPECT_LE(norm(mesh.points[v] - before.points[v]), 1.0001e-3);
}

TEST(Volumes, LeaveASurfaceThatHasThem) {
  Mesh mesh = nested_spheres(2, 500);
  const Mesh before = mesh;
  const Solids solids = find_solids(mesh);
  EXPECT_LT(match_volumes(mesh, solids.sides, solids.volume, all_alike(mesh, 1)), 1e-7);
  EXPECT_EQ(mesh.points, before.points);
}

TEST(Volumes, OfRegionsThatNothingMayMoveAroundStay) {
  Mesh mesh = nested_spheres(2, 500);
  const Solids solids = find_solids(mesh);
  Compliance c = all_alike(mesh, 1);
  for (double& share : c.share) share = 0;
  std::vector<double> volume = solids.volume;
  volume[1] *= 2;
  const Mesh before = mesh;
  EXPECT_GT(match_volumes(mesh, solids.sides, volume, c), 0.1);
  EXPECT_EQ(mesh.points, before.points);
}

}  // namespace
