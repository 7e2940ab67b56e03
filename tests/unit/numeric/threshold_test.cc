// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/threshold.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/squares.h"

using namespace meshpipe;

namespace {

constexpr int n = 20;
constexpr double step_time = 4;  // two edges wide

// +1 in the squares left of edge(y)
template <class Edge>
std::vector<double> left_of(Edge edge) {
  std::vector<double> sign;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) sign.insert(sign.end(), 2, x < edge(y) ? 1.0 : -1.0);
  return sign;
}

// where the field changes sign in row y, on the way from the left
double level_in_row(const std::vector<double>& s, int y) {
  for (int x = 0; x < n; ++x) {
    const double a = s[y * (n + 1) + x], b = s[y * (n + 1) + x + 1];
    if (a >= 0 && b < 0) return x + a / (a - b);
  }
  return -1;
}

}  // namespace

//  ++++--        +++|--
//  ++----   ->   +++|--     teeth vanish, the line stays where it is on average
//  ++++--        +++|--
TEST(Threshold, TakesTheTeethOffASaw) {
  const Mesh m = unit_squares(n);
  const std::vector<double> time(m.tris.size(), step_time), held(m.points.size(), not_held);
  const auto s = threshold_dynamics(m, left_of([](int y) { return y % 2 ? 9 : 11; }), time, held, 3);
  for (int y = 0; y <= n; ++y) EXPECT_NEAR(level_in_row(s, y), 10, 0.7) << y;
}

TEST(Threshold, KeepsHeldVertices) {
  const Mesh m = unit_squares(n);
  const std::vector<double> time(m.tris.size(), step_time);
  std::vector<double> held(m.points.size(), not_held);
  // the line ends at (5, 0) and (15, n), wherever the sides were
  for (int x = 0; x <= n; ++x) {
    held[x] = x < 5 ? 1 : x > 5 ? -1 : 0;
    held[n * (n + 1) + x] = x < 15 ? 1 : x > 15 ? -1 : 0;
  }
  const auto s = threshold_dynamics(m, left_of([](int) { return 10; }), time, held, 12);
  for (std::size_t v = 0; v < s.size(); ++v) {
    if (held[v] == not_held) continue;
    EXPECT_EQ(s[v], held[v]);
  }
  EXPECT_NEAR(level_in_row(s, n / 4), 7.5, 1.5);
  EXPECT_NEAR(level_in_row(s, 3 * n / 4), 12.5, 1.5);
}

// a disk shrinks: its border moves towards its center, faster the smaller it is
TEST(Threshold, ShrinksADisk) {
  const Mesh m = unit_squares(n);
  const std::vector<double> time(m.tris.size(), 1), held(m.points.size(), not_held);
  std::vector<double> sign;
  for (const Tri& t : m.tris) {
    const Vec3 p = (1. / 3) * (m.points[t[0]] + m.points[t[1]] + m.points[t[2]]);
    sign.push_back(std::hypot(p.x - 10, p.y - 10) < 5 ? 1 : -1);
  }
  auto inside = [](const std::vector<double>& s) {
    return std::count_if(s.begin(), s.end(), [](double x) { return x > 0; });
  };
  const auto once = inside(threshold_dynamics(m, sign, time, held, 1)),
             often = inside(threshold_dynamics(m, sign, time, held, 6));
  EXPECT_LT(often, once);
  EXPECT_GT(once, 40);
}
