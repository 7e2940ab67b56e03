// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/threshold.h"

#include <algorithm>
#include <utility>

#include "lib/core/connectivity.h"
#include "lib/numeric/laplacian.h"

namespace meshpipe {
namespace {

/// Mean of the sign of a linear field over a triangle.
double mean_sign(double x, double y, double z) {
  // one corner alone: its share of the area is the product of the crossings' fractions
  if ((x >= 0) == (y >= 0)) std::swap(x, z);
  if ((x >= 0) == (y >= 0)) return x >= 0 ? 1 : -1;
  if ((x >= 0) == (z >= 0)) std::swap(x, y);
  const double alone = x / (x - y) * (x / (x - z));
  return (x >= 0 ? 1 : -1) * (2 * alone - 1);
}

/// M + t K. Rows of held vertices are those of the unit matrix; what they give their neighbors is `given`.
Laplacian heat_step(const Mesh& mesh, const std::vector<double>& area, const std::vector<double>& time,
                    const std::vector<double>& held, std::vector<double>& given) {
  const std::vector<Vec3>& p = mesh.points;
  std::vector<double> diagonal(p.size());
  for (std::size_t v = 0; v < p.size(); ++v) diagonal[v] = held[v] != not_held;
  Laplacian step(std::move(diagonal));
  step.reserve(3 * mesh.tris.size());
  auto row = [&](int v) { return held[v] == not_held ? v : -1; };
  for (std::size_t k = 0; k < mesh.tris.size(); ++k) {
    const Tri& v = mesh.tris[k];
    const auto weight = cotangent_weights(p[v[0]], p[v[1]], p[v[2]], 1e-3);
    for (int i = 0; i < 3; ++i) {
      const int a = v[i], b = v[(i + 1) % 3];
      const double w = time[k] * weight[i];
      step.add_diagonal(row(a), area[k] / 3 + w);
      step.add_diagonal(row(b), w);
      step.couple(row(a), row(b), w);
      if (row(a) >= 0 && row(b) < 0) given[a] += w * held[b];
      if (row(b) >= 0 && row(a) < 0) given[b] += w * held[a];
    }
  }
  return step;
}

}  // namespace

std::vector<double> threshold_dynamics(const Mesh& mesh, std::vector<double> sign,
                                       const std::vector<double>& time, const std::vector<double>& held,
                                       int steps) {
  constexpr double accuracy = 0.002;
  constexpr int most = 200;
  const std::vector<Vec3>& p = mesh.points;
  const std::size_t n = p.size();
  std::vector<double> area, given(n, 0), mass(n, 0), right(n), s(n);
  for (std::size_t k = 0; k < sign.size(); ++k) area.push_back(triangle_area(mesh, (int)k));
  const ConjugateGradients heat((int)n, heat_step(mesh, area, time, held, given).lower_triangle(), accuracy,
                                most);
  for (std::size_t k = 0; k < sign.size(); ++k)
    for (int v : mesh.tris[k]) mass[v] += area[k] / 3;
  for (int step = 0; step < steps; ++step) {
    std::fill(right.begin(), right.end(), 0);
    for (std::size_t k = 0; k < sign.size(); ++k)
      for (int v : mesh.tris[k]) right[v] += area[k] / 3 * sign[k];
    for (std::size_t v = 0; v < n; ++v) {
      if (step == 0) s[v] = mass[v] > 0 ? right[v] / mass[v] : 0;
      if (held[v] != not_held) right[v] = s[v] = 0;
      right[v] += given[v];
    }
    heat.solve(right, s);
    for (std::size_t v = 0; v < n; ++v)
      if (held[v] != not_held) s[v] = held[v];
    for (std::size_t k = 0; k < sign.size(); ++k)
      sign[k] = mean_sign(s[mesh.tris[k][0]], s[mesh.tris[k][1]], s[mesh.tris[k][2]]);
  }
  return steps > 0 ? s : std::vector<double>();
}

}  // namespace meshpipe
