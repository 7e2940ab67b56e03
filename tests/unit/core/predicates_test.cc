// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/predicates.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

using namespace meshpipe;

__extension__ typedef __int128 Int;

static int sign_of(Int x) { return (x > 0) - (x < 0); }

// Integers small enough for 128 bits give the true sign; a power of two takes them to a model's scale without
// rounding.
static const double scales[] = {1, std::ldexp(1, -50), std::ldexp(1, 20), std::ldexp(1, -400),
                                std::ldexp(1, 300)};

TEST(Predicates, Orient2dIsExactOnNearlyCollinearPoints) {
  std::mt19937_64 random(1);
  int zeros = 0;
  for (int k = 0; k < 20000; ++k) {
    // a and b apart by a few units of a large multiple of a direction; c next to their line
    std::int64_t dx = (std::int64_t)(random() % 2000) - 1000, dy = (std::int64_t)(random() % 2000) - 1000;
    std::int64_t m = (std::int64_t)(random() % (1ll << 40)), n = (std::int64_t)(random() % (1ll << 40));
    std::int64_t o = 1ll << 50;
    std::int64_t p[3][2] = {{o, o / 3}, {o + m * dx, o / 3 + m * dy}, {o + n * dx, o / 3 + n * dy}};
    p[2][0] += (int)(random() % 3) - 1;
    p[2][1] += (int)(random() % 3) - 1;
    Int det = (Int)(p[0][0] - p[2][0]) * (p[1][1] - p[2][1]) - (Int)(p[0][1] - p[2][1]) * (p[1][0] - p[2][0]);
    zeros += det == 0;
    for (double s : scales) {
      auto v = [&](int i) { return Vec2{s * (double)p[i][0], s * (double)p[i][1]}; };
      ASSERT_EQ(orient2d(v(0), v(1), v(2)), sign_of(det)) << k << " " << s;
      ASSERT_EQ(orient2d(v(1), v(0), v(2)), -sign_of(det));
    }
  }
  EXPECT_GT(zeros, 100);
}

TEST(Predicates, IncircleIsExactOnNearlyCocircularPoints) {
  std::mt19937_64 random(2);
  int zeros = 0;
  for (int k = 0; k < 20000; ++k) {
    // (+-x, +-y) and (+-y, +-x) lie on one circle; then one of them moves by at most a unit
    std::int64_t x = random() % (1 << 25) + 1, y = random() % (1 << 25) + 1;
    std::int64_t p[4][2] = {{x, y}, {-y, x}, {-x, -y}, {y, -x}};
    p[3][0] += (int)(random() % 3) - 1;
    p[3][1] += (int)(random() % 3) - 1;
    Int e[3][3];
    for (int i = 0; i < 3; ++i) {
      e[i][0] = p[i][0] - p[3][0];
      e[i][1] = p[i][1] - p[3][1];
      e[i][2] = e[i][0] * e[i][0] + e[i][1] * e[i][1];
    }
    Int det = e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]) +
              e[1][2] * (e[2][0] * e[0][1] - e[2][1] * e[0][0]) +
              e[2][2] * (e[0][0] * e[1][1] - e[0][1] * e[1][0]);
    zeros += det == 0;
    for (double s : {1.0, std::ldexp(1, -50), std::ldexp(1, 20), std::ldexp(1, -200), std::ldexp(1, 200)}) {
      auto v = [&](int i) { return Vec2{s * (double)p[i][0], s * (double)p[i][1]}; };
      ASSERT_EQ(incircle(v(0), v(1), v(2), v(3)), sign_of(det)) << k << " " << s;
      ASSERT_EQ(incircle(v(1), v(2), v(0), v(3)), sign_of(det));
    }
  }
  EXPECT_GT(zeros, 100);
}

//        b         d one part in 10^18 outside the unit circle: the differences to d do not fit a double
//      /   \       .
//     c     a      .
//      \   /
//        d
TEST(Predicates, IncircleKeepsWhatTheDifferencesLose) {
  Vec2 a{1, 0}, b{0, 1}, c{-1, 0};
  EXPECT_EQ(incircle(a, b, c, {0, -1}), 0);
  EXPECT_EQ(incircle(a, b, c, {std::ldexp(1, -60), -1}), -1);
  EXPECT_EQ(incircle(a, b, c, {-std::ldexp(1, -60), -1}), -1);
  // raising c by e moves the center down along the diagonal by e^2 / 4
  EXPECT_EQ(incircle(a, b, {-1, std::ldexp(1, -60)}, {0, -1}), 1);
}

TEST(Predicates, Orient3dIsExactOnNearlyCoplanarPoints) {
  std::mt19937_64 random(3);
  int zeros = 0;
  for (int k = 0; k < 20000; ++k) {
    auto r = [&] { return (std::int64_t)(random() % (1 << 16)) - (1 << 15); };
    std::int64_t u[3] = {r(), r(), r()}, w[3] = {r(), r(), r()}, o[3] = {1ll << 38, -(1ll << 37), 7};
    std::int64_t p[4][3];
    for (int i = 0; i < 4; ++i) {
      std::int64_t m = r(), n = r();
      for (int j = 0; j < 3; ++j) p[i][j] = o[j] + m * u[j] + n * w[j];
    }
    p[2][k % 3] += (int)(random() % 3) - 1;
    Int e[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) e[i][j] = p[i][j] - p[3][j];
    Int det = e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]) +
              e[1][2] * (e[2][0] * e[0][1] - e[2][1] * e[0][0]) +
              e[2][2] * (e[0][0] * e[1][1] - e[0][1] * e[1][0]);
    zeros += det == 0;
    for (double s : {1.0, std::ldexp(1, -60), std::ldexp(1, 100)}) {
      auto v = [&](int i) { return Vec3{s * (double)p[i][0], s * (double)p[i][1], s * (double)p[i][2]}; };
      ASSERT_EQ(orient3d(v(0), v(1), v(2), v(3)), sign_of(det)) << k << " " << s;
      ASSERT_EQ(orient3d(v(1), v(0), v(2), v(3)), -sign_of(det));
    }
  }
  EXPECT_GT(zeros, 100);
}

TEST(Predicates, TheSmallestDoubles) {
  const double d = 5e-324;
  EXPECT_EQ(orient2d({0, 0}, {d, 0}, {0, d}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, d}, {d, 0}), -1);
  EXPECT_EQ(orient2d({0, 0}, {d, d}, {3 * d, 3 * d}), 0);
  EXPECT_EQ(incircle({0, 0}, {4 * d, 0}, {0, 4 * d}, {d, d}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {d, 0, 0}, {0, d, 0}, {0, 0, -d}), 1);
}

TEST(Predicates, SignsFollowTheConvention) {
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}), 1);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {2, 2}), -1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), 1);
  EXPECT_EQ(orient2d({3, 3}, {3, 3}, {3, 3}), 0);
  EXPECT_EQ(orient2d({0, 0}, {0, 0}, {0, 0}), 0);
}
