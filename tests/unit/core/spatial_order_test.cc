// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/spatial_order.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace meshpipe;

namespace {

// a grid of squares, its points shuffled
Mesh shuffled_grid(int n) {
  Mesh mesh;
  const int all = n * n;
  auto at = [&](int i, int j) { return (int)((std::int64_t)(i * n + j) * 37 % all); };
  mesh.points.resize(all);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) mesh.points[at(i, j)] = {(double)i, (double)j, 0};
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      mesh.tris.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.tris.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(SpatialOrder, SuccessivePointsOfALatticeAreNeighbors) {
  Mesh mesh;
  for (int i = 0; i < 512; ++i) {
    const int at = i * 37 % 512;
    mesh.points.push_back({(double)(at / 64), (double)(at / 8 % 8), (double)(at % 8)});
  }
  const std::vector<int> order = spatial_order(mesh).vertices;
  ASSERT_EQ(order.size(), mesh.points.size());
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    EXPECT_EQ(norm(mesh.points[order[i + 1]] - mesh.points[order[i]]), 1) << i;
}

TEST(SpatialOrder, TrianglesFollowTheirFirstVertex) {
  Mesh mesh = shuffled_grid(16);
  rearrange(mesh, spatial_order(mesh));
  auto first = [](const Tri& t) { return *std::min_element(t.begin(), t.end()); };
  EXPECT_TRUE(std::is_sorted(mesh.tris.begin(), mesh.tris.end(),
                             [&](const Tri& a, const Tri& b) { return first(a) < first(b); }));
}

TEST(SpatialOrder, TheMeshStaysTheSame) {
  const Mesh mesh = shuffled_grid(8);
  const SpatialOrder order = spatial_order(mesh);
  Mesh moved = mesh;
  rearrange(moved, order);
  const std::vector<int> row = new_rows(order.tris);
  for (std::size_t t = 0; t < mesh.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) EXPECT_EQ(moved.points[moved.tris[row[t]][i]], mesh.points[mesh.tris[t][i]]);
}

TEST(SpatialOrder, PointsAtOnePlaceKeepTheirOrder) {
  EXPECT_EQ(spatial_order(Mesh{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {}}).vertices, (std::vector<int>{0, 1, 2}));
}

}  // namespace
