// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/multigrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace meshpipe;

namespace {

/// The Laplacian of a grid of wide x high points with random weights of all edges between 1 and `most`, and
/// zero held next to it; as entries of the lower triangle.
std::vector<Entry<double>> grid(int wide, int high, double most) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> power(0, 1);
  std::vector<Entry<double>> lower;
  auto couple = [&](int i, int j) {
    const double w = std::pow(most, power(random));
    lower.push_back({i, i, w});
    if (j < 0) return;
    lower.push_back({j, j, w});
    lower.push_back({std::max(i, j), std::min(i, j), -w});
  };
  for (int y = 0; y < high; ++y)
    for (int x = 0; x < wide; ++x) {
      couple(wide * y + x, x + 1 < wide ? wide * y + x + 1 : -1);
      couple(wide * y + x, y + 1 < high ? wide * y + x + wide : -1);
    }
  return lower;
}

Multigrid::Matrix matrix_of(int n, const std::vector<Entry<double>>& lower) {
  std::vector<Eigen::Triplet<double>> all;
  for (const auto& e : lower) {
    all.emplace_back(e.row, e.col, e.value);
    if (e.row != e.col) all.emplace_back(e.col, e.row, e.value);
  }
  Multigrid::Matrix m(n, n);
  m.setFromTriplets(all.begin(), all.end());
  return m;
}

std::vector<double> two_columns(int n) {
  std::vector<double> b;
  for (int i = 0; i < 2 * n; ++i) b.push_back(i < n ? std::sin(0.01 * i) : i % 97 == 0);
  return b;
}

}  // namespace

TEST(Multigrid, SolvesWhatAFactorizationSolves) {
  const int side = 120, n = side * side;
  for (double most : {1.0, 10.0, 1e4}) {
    const auto lower = grid(side, side, most);
    std::vector<double> direct = two_columns(n), b = direct;
    Factorization<double>(n, lower).solve(direct);
    ASSERT_TRUE(Multigrid(matrix_of(n, lower)).solve(b)) << most;
    for (int c = 0; c < 2; ++c) {
      double largest = 0, off = 0;
      for (int i = c * n; i < (c + 1) * n; ++i) {
        largest = std::max(largest, std::abs(direct[i]));
        off = std::max(off, std::abs(b[i] - direct[i]));
      }
      EXPECT_LT(off, 1e-8 * largest) << most << " column " << c;
    }
  }
}

TEST(Multigrid, EveryColumnIsSolvedAsIfAlone) {
  const int side = 70, n = side * side;
  const Multigrid multigrid(matrix_of(n, grid(side, side, 3)));
  std::vector<double> b = two_columns(n), three = b;
  three.insert(three.end(), b.begin(), b.begin() + n);  // a pair, and one that is left
  ASSERT_TRUE(multigrid.solve(three));
  for (int i = 0; i < n; ++i) EXPECT_NEAR(three[i], three[2 * n + i], 1e-9 * std::abs(three[i]));
  std::vector<double> none(n, 0);
  ASSERT_TRUE(multigrid.solve(none));
  EXPECT_EQ(none, std::vector<double>(n, 0));
}

// The bending of a beam is no Laplacian: large entries of both signs off the diagonal.
TEST(Multigrid, WhatDoesNotConvergeIsGivenBackAndFactorized) {
  const int n = 4000;
  std::vector<Entry<double>> lower;
  for (int i = 0; i < n; ++i) {
    lower.push_back({i, i, 6});
    if (i >= 1) lower.push_back({i, i - 1, -4});
    if (i >= 2) lower.push_back({i, i - 2, 1});
  }
  std::vector<double> b = two_columns(n), given = b;
  EXPECT_FALSE(Multigrid(matrix_of(n, lower)).solve(b));
  EXPECT_EQ(b, given);
}

TEST(Multigrid, FactorizationTakesItWhereItIsFaster) {
  const int n = 160000;
  for (int high : {2, 400}) {
    const auto lower = grid(n / high, high, 2);
    std::vector<double> direct = two_columns(n), x = direct;
    Factorization<double>(n, lower).solve(direct);
    Factorization<double>(n, lower, MatrixKind::laplacian).solve(x);
    if (high == 2)
      EXPECT_EQ(x, direct);
    else
      EXPECT_NE(x, direct);
    for (int i = 0; i < n; ++i) ASSERT_NEAR(x[i], direct[i], 1e-8) << high << " row " << i;
  }
}

// The bending of a plate: the square of a Laplacian, no Laplacian itself.
TEST(Multigrid, FactorizationIsThereWhereItDoesNotConverge) {
  const int side = 200, n = side * side;
  const Multigrid::Matrix laplacian = matrix_of(n, grid(side, side, 10)), plate = laplacian * laplacian;
  std::vector<Entry<double>> lower;
  for (int i = 0; i < n; ++i)
    for (Multigrid::Matrix::InnerIterator e(plate, i); e; ++e)
      if (e.col() <= i) lower.push_back({i, (int)e.col(), e.value()});
  std::vector<double> direct = two_columns(n), x = direct;
  EXPECT_FALSE(Multigrid(plate).solve(x));
  Factorization<double>(n, lower).solve(direct);
  Factorization<double>(n, lower, MatrixKind::laplacian).solve(x);
  EXPECT_EQ(x, direct);
}
