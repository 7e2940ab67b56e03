// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/laplacian.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lib/core/error.h"

using namespace meshpipe;

TEST(Laplacian, CotangentWeights) {
  // right isosceles triangle: right angle at a, 45 degrees at b and c
  auto w = cotangent_weights({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(w[0], 0.5, 1e-15);  // edge a-b, opposite to c
  EXPECT_NEAR(w[1], 0, 1e-15);    // edge b-c, opposite to a
  EXPECT_NEAR(w[2], 0.5, 1e-15);
  EXPECT_NEAR(cotangent_weights({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.01)[1], 0.005, 1e-15);
  // flat, needle and point-like triangles: finite, and cot a cot b + cot b cot c + cot c cot a = 1
  for (auto t : {std::array<Vec3, 3>{{{0, 0, 0}, {1, 0, 0}, {0.3, 0, 0}}},
                 std::array<Vec3, 3>{{{0, 0, 0}, {0, 0, 0}, {1e-7, 0, 0}}},
                 std::array<Vec3, 3>{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}}) {
    auto f = cotangent_weights(t[0], t[1], t[2]);
    EXPECT_NEAR(4 * (f[0] * f[1] + f[1] * f[2] + f[2] * f[0]), 1, 1e-4);
    for (double x : f) EXPECT_LT(std::abs(x), 2e5);
  }
}

//  3-------2
//  | \   / |   unit square, its center 4 free
//  |   4   |
//  | /   \ |
//  0-------1
TEST(Laplacian, DirichletSolveKeepsLinearFunctions) {
  std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3, 0.6, 0}};
  std::vector<std::array<int, 3>> tris{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  std::vector<double> w;
  for (auto t : tris)
    for (double x : cotangent_weights(p[t[0]], p[t[1]], p[t[2]])) w.push_back(x);
  std::vector<Vec2> uv{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {9, 9}};
  solve_dirichlet(tris, w, {1, 1, 1, 1, 0}, uv);
  EXPECT_NEAR(uv[4].x, 0.3, 1e-14);
  EXPECT_NEAR(uv[4].y, 0.6, 1e-14);
  EXPECT_THROW(solve_dirichlet(tris, w, {0, 0, 0, 0, 0}, uv), GoalMissed);
}

TEST(Laplacian, HeldEndsOnlyCountOnTheDiagonal) {
  Laplacian l(std::vector<double>{0.5, 0});
  l.add_edge(0, 1, 2);
  l.add_edge(1, 0, 1);
  l.add_edge(1, -1, 4);
  l.add_edge(0, 0, 7);
  double sum[2][2] = {};
  for (const auto& [row, col, value] : l.lower_triangle()) {
    EXPECT_GE(row, col);
    sum[row][col] += value;
  }
  EXPECT_EQ(sum[0][0], 3.5);
  EXPECT_EQ(sum[1][0], -3);
  EXPECT_EQ(sum[1][1], 7);
}

TEST(Laplacian, FactorizesWhatWasAdded) {
  Laplacian l(2);
  l.add_edge(0, 1, 1);
  l.add_edge(0, -1, 1);
  std::vector<double> b{0, 1};
  l.factorize().solve(b);
  EXPECT_NEAR(b[0], 1, 1e-15);
  EXPECT_NEAR(b[1], 2, 1e-15);
}
