// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/sparse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "lib/core/error.h"

using namespace meshpipe;
using Complex = std::complex<double>;

TEST(Sparse, EntriesAtOnePlaceAddUp) {
  // [4 1; 1 3] with the 4 and the 1 given in pieces
  Factorization<double> f(2, {{1, 0, 0.25}, {0, 0, 1}, {1, 1, 3}, {1, 0, 0.75}, {0, 0, 3}});
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
  Factorization<Complex>(n, lower).solve(b);
  for (int i = 0; i < n; ++i) EXPECT_LT(std::abs(b[i] - x[i]), 1e-12);
}

TEST(Sparse, SingularMatricesAreRefused) {
  EXPECT_THROW(Factorization<double>(2, {{0, 0, 1}, {1, 0, -1}, {1, 1, 1}}), GoalMissed);
  EXPECT_THROW(Factorization<double>(1, {{0, 0, -1}}), GoalMissed);
  EXPECT_THROW(Factorization<double>(1, {{0, 0, std::nan("")}}), GoalMissed);
  // a path of three with nothing held: its last pivot is rounding only
  EXPECT_THROW(Factorization<double>(3, {{0, 0, .1}, {1, 0, -.1}, {1, 1, .4}, {2, 1, -.3}, {2, 2, .3}}),
               GoalMissed);
}

TEST(Sparse, ConjugateGradientsImproveAGuess) {
  // a chain of springs held at its first end
  const int n = 50;
  std::vector<Entry<double>> lower{{0, 0, 1}};
  for (int i = 1; i < n; ++i) {
    lower.push_back({i - 1, i - 1, 1});
    lower.push_back({i, i, 1});
    lower.push_back({i, i - 1, -1});
  }
  std::vector<double> pull(n, 0), x(n, 0.5);
  pull[n - 1] = 1;
  ConjugateGradients(n, lower, 1e-12, 200).solve(pull, x);
  for (int i = 0; i < n; ++i) EXPECT_NEAR(x[i], i + 1, 1e-8);
  std::vector<double> one_step(n, 0);
  ConjugateGradients(n, lower, 1e-12, 1).solve(pull, one_step);
  EXPECT_LT(one_step[n - 1], n / 2);
}

// x + 2 y = 5 and 3 x + 4 y = 11, for two right-hand sides; a singular one
TEST(Sparse, UnsymmetricSystems) {
  std::vector<double> b{5, 11, 1, 3};
  solve_unsymmetric(2, {{0, 0, 1}, {0, 1, 1}, {0, 1, 1}, {1, 0, 3}, {1, 1, 4}}, b);
  EXPECT_NEAR(b[0], 1, 1e-14);
  EXPECT_NEAR(b[1], 2, 1e-14);
  EXPECT_NEAR(b[2], 1, 1e-14);
  EXPECT_NEAR(b[3], 0, 1e-14);
  EXPECT_THROW(solve_unsymmetric(2, {{0, 0, 1}, {0, 1, 2}, {1, 0, 2}, {1, 1, 4}}, b), GoalMissed);
}

TEST(Sparse, AnotherMatrixOfTheSamePlaces) {
  Factorization<double> f(2, {{0, 0, 2}, {1, 0, 1}, {1, 1, 2}});
  f.refactor({{0, 0, 4}, {1, 0, 0}, {1, 1, 5}});
  std::vector<double> b{4, 10, 8, 5};
  f.solve(b);
  EXPECT_NEAR(b[0], 1, 1e-14);
  EXPECT_NEAR(b[1], 2, 1e-14);
  EXPECT_NEAR(b[2], 2, 1e-14);
  EXPECT_NEAR(b[3], 1, 1e-14);
  EXPECT_THROW(f.refactor({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}), GoalMissed);
}
