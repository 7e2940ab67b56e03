// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/circle.h"

#include <algorithm>
#include <numbers>

namespace meshpipe {
namespace {

/// Solves the equations of the mean-value weights, which are positive and not symmetric.
void solve_mean_value(const Filled& filled, const std::vector<char>& fixed, std::vector<Vec2>& uv) {
  std::vector<int> unknown(filled.n_vertices, -1);
  int n = 0;
  for (int v = 0; v < filled.n_vertices; ++v)
    if (!fixed[v]) unknown[v] = n++;
  std::vector<Entry<double>> matrix;
  std::vector<double> diagonal(n, 0), b(2 * n, 0);
  matrix.reserve(6 * filled.tris.size() + n);
  for (std::size_t t = 0; t < filled.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      int row = unknown[filled.tris[t][i]];
      if (row < 0) continue;
      const auto& p = filled.shape[t];
      Vec3 e[2] = {p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]};
      double scale = norm(e[0]) + norm(e[1]);
      double bend = scale > 0 ? std::clamp(std::tan(0.5 * angle(e[0], e[1])), 1e-6, 1e6) : 1;
      for (int k = 0; k < 2; ++k) {
        int v = filled.tris[t][(i + 1 + k) % 3];
        // edges without length take bounded weights
        double w = bend / std::max(norm(e[k]), scale > 0 ? 1e-6 * scale : 1);
        diagonal[row] += w;
        if (unknown[v] >= 0) {
          matrix.push_back({row, unknown[v], -w});
        } else {
          b[row] += w * uv[v].x;
          b[n + row] += w * uv[v].y;
        }
      }
    }
  // rows of a mean each, whatever the lengths
  for (Entry<double>& e : matrix) e.value /= diagonal[e.row];
  for (int i = 0; i < n; ++i) {
    matrix.push_back({i, i, 1});
    b[i] /= diagonal[i];
    b[n + i] /= diagonal[i];
  }
  solve_unsymmetric(n, matrix, b);
  for (int v = 0; v < filled.n_vertices; ++v)
    if (unknown[v] >= 0) uv[v] = {b[unknown[v]], b[n + unknown[v]]};
}

}  // namespace

std::vector<Vec2> circle_border(const SubMesh& part, const Disk& disk) {
  const auto& rim = disk.loops[0];
  std::vector<Vec2> uv(part.points.size());
  double shortest = 0.01 * disk.length[0] / (double)rim.size(), length = 0, at = 0;
  if (!(shortest > 0)) shortest = 1;
  for (int h : rim) length += std::max(edge_length(part, h), shortest);
  for (int h : rim) {
    double a = 2 * std::numbers::pi * at / length;
    uv[origin(part.tris, h)] = {std::cos(a), std::sin(a)};
    at += std::max(edge_length(part, h), shortest);
  }
  return uv;
}

std::vector<Vec2> extend_border(const SubMesh& part, const Filled& filled, const Disk& disk, Weights weights,
                                std::vector<Vec2> border) {
  std::size_t n_points = border.size();
  std::vector<char> fixed(filled.n_vertices, 0);
  for (int h : disk.loops[0]) fixed[origin(part.tris, h)] = 1;
  border.resize(filled.n_vertices);
  if (weights == Weights::mean_value) {
    solve_mean_value(filled, fixed, border);
  } else {
    // positive weights make it one-to-one; bounded ones keep it so in floating point
    std::vector<double> w = weights == Weights::uniform     ? std::vector<double>(3 * filled.tris.size(), 0.5)
                            : weights == Weights::cotangent ? cotangents(filled.shape, 0.01, 100)
                                                            : cotangents(filled.shape);
    solve_dirichlet(filled.tris, w, fixed, border);
  }
  border.resize(n_points);
  return border;
}

}  // namespace meshpipe
