// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/triangle_count.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lib/core/sectors.h"

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

/// Twice the integral of dA / h^2 over triangle t.
double asked_in(const Mesh& mesh, const std::vector<double>& size, int t) {
  const auto [a, b, c] = mesh.tris[t];
  return norm(area_vector(mesh, t)) * mean_inverse_square({size[a], size[b], size[c]});
}
const double per_asked = 2 / std::sqrt(3.0);  ///< triangles

}  // namespace

double size_for_count(double area, double n) {
  // an equilateral triangle of edge h has area h^2 sqrt(3) / 4
  return std::sqrt(4 * area / (std::sqrt(3.0) * n));
}

double count_for_size(const Mesh& mesh, const std::vector<double>& size) {
  double n = 0;
  for (int t = 0; t < (int)mesh.tris.size(); ++t) n += asked_in(mesh, size, t);
  return per_asked * n;
}

double count_with_borders(const Connectivity& surface, const std::vector<int>& part,
                          const std::vector<double>& size) {
  const int n = surface.n_half_edges();
  auto is_line = [&](int h) {
    return is_feature(surface, h) || surface.is_model(surface.opposite[h]) ||
           part[h / 3] != part[surface.opposite[h] / 3];
  };
  constexpr int counted = -1;  // a vertex inside of a part
  std::vector<int> lines_at(surface.n_vertices(), 0);
  for (int h = 0; h < n; ++h) {
    if (is_line(h)) ++lines_at[surface.from(h)];
    if (surface.is_border(h)) ++lines_at[surface.to(h)];
  }
  struct Count {
    double asked = 0, segments = 0, corners = 0;  // along borders; lines inside a part count on both sides
    double euler = 0;                             // characteristic
  };
  std::vector<Count> of(part.empty() ? 0 : 1 + *std::max_element(part.begin(), part.end()));
  for (int h = 0; h < n; ++h) {
    Count& c = of[part[h / 3]];
    int& lines = lines_at[surface.from(h)];
    if (h % 3 == 0) c.asked += per_asked * asked_in(surface.mesh, size, h / 3), c.euler -= 0.5;
    if (lines == 0) lines = counted, c.euler += 1;
    if (!is_line(h)) continue;
    c.segments += 2 * surface.length(h) / (size[surface.from(h)] + size[surface.to(h)]);
    c.corners += lines > 2;
    c.euler += 0.5;
  }
  double sum = 0;
  for (const Count& c : of) sum += std::max(c.asked, std::max(c.segments, c.corners) - 2 * c.euler);
  return sum;
}

}  // namespace meshpipe
