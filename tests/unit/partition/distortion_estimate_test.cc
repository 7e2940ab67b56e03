// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/distortion_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lib/core/regions.h"
#include "lib/core/topology.h"

using namespace meshpipe;

namespace {

constexpr double tau = 6.283185307179586;

// n x m squares of two triangles, placed from (0..1, 0..1); closed: the last column of points is the first
template <class Place>
Mesh grid(int n, int m, bool closed, Place place) {
  Mesh s;
  const int w = closed ? n : n + 1;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < w; ++i) s.points.push_back(place((double)i / n, (double)j / m));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * w + i, b = j * w + (i + 1) % w;
      s.tris.push_back({a, b, b + w});
      s.tris.push_back({a, b + w, a + w});
    }
  return s;
}

DistortionEstimate estimate(const Mesh& m, const std::vector<int>& label, int a, int b) {
  const auto opposite = opposite_halfedges(m.tris, (int)m.points.size());
  std::vector<int> border;
  auto inside = [&](int t) { return label[t] == a || label[t] == b; };
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (inside(h / 3) && (opposite[h] < 0 || !inside(opposite[h] / 3))) border.push_back(h);
  return DistortionModel({m, opposite}).of(label, a, b, border);
}

DistortionEstimate estimate(const Mesh& m) { return estimate(m, std::vector<int>(m.tris.size(), 0), 0, 0); }

}  // namespace

TEST(DistortionEstimate, AFlatSheetStaysAsItIs) {
  const DistortionEstimate f = estimate(grid(20, 15, false, [](double x, double y) {
    return Vec3{x, y, 0};
  }));
  EXPECT_NEAR(f.area_distortion, 1, 1e-6);
  EXPECT_EQ(f.crossings, 0);
}

// A tube becomes a ring: the scale falls by exp(-z / R), areas by its square; 2 % of the height are left out.
TEST(DistortionEstimate, TubesShrinkExponentially) {
  for (double height : {2.0, 6.0, 12.0}) {
    const DistortionEstimate f = estimate(grid(24, (int)(4 * height), true, [&](double x, double y) {
      return Vec3{std::cos(tau * x), std::sin(tau * x), height * y};
    }));
    EXPECT_NEAR(std::log(f.area_distortion), 2 * 0.98 * height, 0.2 * 2 * height);
    EXPECT_EQ(f.crossings, 0);
  }
}

// The same tube in two labels, joined: the estimate of a union does not depend on the labels in it.
TEST(DistortionEstimate, AUnionIsOneRegion) {
  const Mesh m = grid(24, 24, true, [](double x, double y) {
    return Vec3{std::cos(tau * x), std::sin(tau * x), 6 * y};
  });
  std::vector<int> label(m.tris.size());
  for (std::size_t t = 0; t < label.size(); ++t) label[t] = t < label.size() / 3 ? 4 : 7;
  EXPECT_DOUBLE_EQ(estimate(m, label, 4, 7).area_distortion, estimate(m).area_distortion);
  EXPECT_LT(estimate(m, label, 7, 7).area_distortion, estimate(m).area_distortion);
}

// A ramp that winds one and a half times round at the same radius lies on itself in the plane; half a turn
// does not.
TEST(DistortionEstimate, RampsOverlap) {
  auto ramp = [](double turns) {
    return grid((int)(60 * turns), 4, false, [&](double x, double y) {
      const double a = tau * turns * x, r = 1 + y;
      return Vec3{r * std::cos(a), r * std::sin(a), 0.05 * a};
    });
  };
  EXPECT_GT(estimate(ramp(1.5)).crossings, 0);
  EXPECT_EQ(estimate(ramp(0.5)).crossings, 0);
}
