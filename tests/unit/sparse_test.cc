// SPDX-License-Identifier: BSD-3-Clause
#include "lib/sparse.h"

#include <gtest/gtest.h>

#include "lib/error.h"

using namespace meshpipe;
using Complex = std::complex<double>;

TEST(Sparse, EntriesAtOnePlaceAddUp) {
  // [4 1; 1 3] with the 4 and the 1 given in pieces
  Factorisation<double> f(2, {{1, 0, 0.25}, {0, 0, 1}, {1, 1, 3}, {1, 0, 0.75}, {0, 0, 3}});
  std::vector<double> b{6, 7};
  f.solve(b);
  EXPECT_NEAR(b[0], 1, 1e-15);
  EXPECT_NEAR(b[1], 2, 1e-15);
}

TEST(Sparse, ComplexMatricesAreHermitianNotSymmetric) {
  // the lower triangle of a diagonally dominant A = A^H with a random-looking pattern, so that AMD permutes
  // it
  const int n = 40;
  std::vector<std::vector<Complex>> a(n, std::vector<Complex>(n));
  std::vector<Entry<Complex>> lower;
  for (int i = 0; i < n; ++i) {
    a[i][i] = 10;
    lower.push_back({i, i, 10});
    for (int k : {1, 7, 12}) {
      int j = (i * k + 3 * k) % n;
      if (j >= i || a[i][j] != Complex(0)) continue;
      a[i][j] = Complex(std::sin(i + k), std::cos(j * k));
      a[j][i] = std::conj(a[i][j]);
      lower.push_back({i, j, a[i][j]});
    }
  }
  std::vector<Complex> x(n), b(n);
  for (int i = 0; i < n; ++i) x[i] = Complex(i, 1 - 0.5 * i);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) b[i] += a[i][j] * x[j];
  Factorisation<Complex>(n, lower).solve(b);
  for (int i = 0; i < n; ++i) EXPECT_LT(std::abs(b[i] - x[i]), 1e-12);
}

TEST(Sparse, SingularMatricesAreRefused) {
  EXPECT_THROW(Factorisation<double>(2, {{0, 0, 1}, {1, 0, -1}, {1, 1, 1}}), GoalMissed);
  EXPECT_THROW(Factorisation<double>(1, {{0, 0, -1}}), GoalMissed);
  EXPECT_THROW(Factorisation<double>(1, {{0, 0, std::nan("")}}), GoalMissed);
  // a path of three with nothing held: its last pivot is rounding only
  EXPECT_THROW(Factorisation<double>(3, {{0, 0, .1}, {1, 0, -.1}, {1, 1, .4}, {2, 1, -.3}, {2, 2, .3}}),
               GoalMissed);
}

TEST(Sparse, CotangentWeights) {
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
//  | \   / |   unit square, its centre 4 free
//  |   4   |
//  | /   \ |
//  0-------1
TEST(Sparse, DirichletSolveKeepsLinearFunctions) {
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

// x + 2 y = 5 and 3 x + 4 y = 11, for two right-hand sides; a singular one
TEST(Sparse, UnsymmetricSystems) {
  std::vector<double> b{5, 11, 1, 3};
  SolveTime time;
  solve_unsymmetric(2, {{0, 0, 1}, {0, 1, 1}, {0, 1, 1}, {1, 0, 3}, {1, 1, 4}}, b, &time);
  EXPECT_NEAR(b[0], 1, 1e-14);
  EXPECT_NEAR(b[1], 2, 1e-14);
  EXPECT_NEAR(b[2], 1, 1e-14);
  EXPECT_NEAR(b[3], 0, 1e-14);
  EXPECT_GT(time.ordering + time.factorisation + time.solve, 0);
  EXPECT_THROW(solve_unsymmetric(2, {{0, 0, 1}, {0, 1, 2}, {1, 0, 2}, {1, 1, 4}}, b), GoalMissed);
}

TEST(Sparse, AnotherMatrixOfTheSamePlaces) {
  Factorisation<double> f(2, {{0, 0, 2}, {1, 0, 1}, {1, 1, 2}});
  f.refactor({{0, 0, 4}, {1, 0, 0}, {1, 1, 5}});
  std::vector<double> b{4, 10, 8, 5};
  f.solve(b);
  EXPECT_NEAR(b[0], 1, 1e-14);
  EXPECT_NEAR(b[1], 2, 1e-14);
  EXPECT_NEAR(b[2], 2, 1e-14);
  EXPECT_NEAR(b[3], 1, 1e-14);
  EXPECT_THROW(f.refactor({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}), GoalMissed);
}
