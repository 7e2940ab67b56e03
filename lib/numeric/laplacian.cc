// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/laplacian.h"

#include <cmath>

namespace meshpipe {

std::vector<Entry<double>> Laplacian::lower_triangle() {
  for (int i = 0; i < rows(); ++i) entries_.push_back({i, i, diagonal_[i]});
  return std::exchange(entries_, {});
}

std::array<double, 3> cotangent_weights(Vec3 a, Vec3 b, Vec3 c, double floor) {
  // the edges i -> i+1 and their lengths; the angle opposite to edge i lies between the other two edges
  std::array<Vec3, 3> e{b - a, c - b, a - c};
  std::array<double, 3> l{norm(e[0]), norm(e[1]), norm(e[2])};
  double longest = std::max({l[0], l[1], l[2]}), area2 = norm(cross(e[0], e[1]));
  constexpr double flat = 1e-5;
  std::array<double, 3> weight;
  if (area2 > flat * longest * longest) {
    for (int i = 0; i < 3; ++i) weight[i] = -dot(e[(i + 1) % 3], e[(i + 2) % 3]) / area2;
  } else {
    // a flatter triangle has its edges lengthened alike until it is a proper one (Sharp and Crane 2020): a
    // true element of a slightly wrong shape, with cotangents up to about 1e5 and still sum cot a cot b = 1
    if (longest == 0) l.fill(longest = 1);
    for (double more = 1e-9 * longest, area4 = 0; area4 <= 2 * flat * longest * longest; more *= 2) {
      for (double& x : l) x += more;
      // four times the area by Heron's formula in Kahan's stable order
      std::array<double, 3> s = l;
      std::sort(s.begin(), s.end());
      double product =
          (s[2] + (s[1] + s[0])) * (s[0] - (s[2] - s[1])) * (s[0] + (s[2] - s[1])) * (s[2] + (s[1] - s[0]));
      area4 = std::sqrt(std::max(product, 0.0));
      for (int i = 0; i < 3; ++i) {
        double x = l[i], y = l[(i + 1) % 3], z = l[(i + 2) % 3];
        weight[i] = (y * y + z * z - x * x) / area4;
      }
    }
  }
  for (double& w : weight) w = 0.5 * std::max(w, floor);
  return weight;
}

void solve_dirichlet(const std::vector<std::array<int, 3>>& tris, const std::vector<double>& weights,
                     const std::vector<char>& fixed, std::vector<Vec2>& uv) {
  // unknowns: the free vertices that a triangle uses, in order
  int n_points = (int)uv.size(), n = 0;
  std::vector<int> unknown(n_points, -1);
  for (const auto& t : tris)
    for (int v : t)
      if (!fixed[v]) unknown[v] = 0;
  for (int& u : unknown)
    if (u == 0) u = n++;
  if (n == 0) return;

  Laplacian laplacian(n);
  std::vector<double> b(2 * n, 0);  // x of all, then y
  auto hold = [&](int i, int at, double w) {
    b[i] += w * uv[at].x;
    b[n + i] += w * uv[at].y;
  };
  for (std::size_t h = 0; h < weights.size(); ++h) {
    const int a = tris[h / 3][h % 3], c = tris[h / 3][(h + 1) % 3], i = unknown[a], j = unknown[c];
    laplacian.add_edge(i, j, weights[h]);
    if (i >= 0 && j < 0) hold(i, c, weights[h]);
    if (j >= 0 && i < 0) hold(j, a, weights[h]);
  }
  laplacian.factorize(MatrixKind::laplacian).solve(b);
  for (int v = 0; v < n_points; ++v)
    if (unknown[v] >= 0) uv[v] = {b[unknown[v]], b[n + unknown[v]]};
}

}  // namespace meshpipe
