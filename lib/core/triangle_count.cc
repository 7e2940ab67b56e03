// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/triangle_count.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meshpipe {
namespace {

constexpr double steep = 2;  ///< ratio of sizes on a triangle, from which their mean does not stand for them

/// Returns the mean of 1/h^2 over a triangle where h is linear: twice the second divided difference of -log h
/// (Hermite and Genocchi).
double mean_inverse_square(std::array<double, 3> h) {
  std::sort(h.begin(), h.end());
  const auto [a, b, c] = h;
  if (!(a > 0) || c < steep * a) return 9 / ((a + b + c) * (a + b + c));
  auto slope = [](double x, double y) { return y - x > 1e-6 * x ? std::log(y / x) / (y - x) : 2 / (x + y); };
  return 2 * (slope(a, b) - slope(b, c)) / (c - a);
}

}  // namespace

double size_for_count(double area, double n) {
  // an equilateral triangle of edge h has area h^2 sqrt(3) / 4
  return std::sqrt(4 * area / (std::sqrt(3.0) * n));
}

double count_for_size(const Mesh& mesh, const std::vector<double>& size) {
  double n = 0;
  for (const Tri& t : mesh.tris) {
    n += norm(area_vector(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]])) *
         mean_inverse_square({size[t[0]], size[t[1]], size[t[2]]});
  }
  return 2 / std::sqrt(3.0) * n;
}

}  // namespace meshpipe
