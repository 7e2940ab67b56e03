// SPDX-License-Identifier: BSD-3-Clause
#include "lib/threshold.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lib/sparse.h"

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

/// The operator of a heat step, scaled to a diagonal of ones; rows of held vertices are those of the unit
/// matrix, and their values stand on the right-hand side.
class HeatStep {
 public:
  HeatStep(const Mesh& mesh, const std::vector<double>& area, const std::vector<double>& time,
           const std::vector<double>& held)
      : tris_(mesh.tris), held_(held), weight_(mesh.tris.size()), scale_(held.size(), 0) {
    const std::vector<Vec3>& p = mesh.points;
    for (std::size_t k = 0; k < tris_.size(); ++k) {
      const Tri& v = tris_[k];
      weight_[k] = cotangent_weights(p[v[0]], p[v[1]], p[v[2]], 1e-3);
      for (int i = 0; i < 3; ++i) {
        weight_[k][i] *= time[k];
        scale_[v[i]] += area[k] / 3 + weight_[k][i];
        scale_[v[(i + 1) % 3]] += weight_[k][i];
      }
    }
    for (double& s : scale_) s = s > 0 ? 1 / std::sqrt(s) : 1;
    for (std::size_t k = 0; k < tris_.size(); ++k)
      for (int i = 0; i < 3; ++i) weight_[k][i] *= scale_[tris_[k][i]] * scale_[tris_[k][(i + 1) % 3]];
  }

  /// s, which is where it begins, such that the step's operator makes `right` of it, by conjugate gradients.
  void solve(const std::vector<double>& right, std::vector<double>& s) {
    constexpr double accuracy = 0.01;
    constexpr int most = 200;
    const std::size_t n = s.size();
    x_.resize(n), r_.resize(n), d_.resize(n), q_.resize(n);
    for (std::size_t v = 0; v < n; ++v) x_[v] = held_[v] == not_held ? s[v] / scale_[v] : 0;
    multiply(x_, q_);
    // what the held vertices give their neighbours
    for (std::size_t k = 0; k < tris_.size(); ++k)
      for (int i = 0; i < 3; ++i) {
        const int a = tris_[k][i], b = tris_[k][(i + 1) % 3];
        if ((held_[a] == not_held) == (held_[b] == not_held)) continue;
        const int from = held_[a] == not_held ? b : a;
        q_[a + b - from] -= weight_[k][i] * held_[from] / scale_[from];
      }
    double all = 0, rr = 0;
    for (std::size_t v = 0; v < n; ++v) {
      const bool is_free = held_[v] == not_held;
      const double b = is_free ? right[v] * scale_[v] : 0;
      r_[v] = d_[v] = is_free ? b - q_[v] : 0;
      all += b * b;
      rr += r_[v] * r_[v];
    }
    for (int i = 0; i < most && rr > accuracy * accuracy * all; ++i) {
      multiply(d_, q_);
      double dq = 0;
      for (std::size_t v = 0; v < n; ++v) dq += d_[v] * q_[v];
      if (!(dq > 0)) break;
      const double along = rr / dq;
      double after = 0;
      for (std::size_t v = 0; v < n; ++v) {
        x_[v] += along * d_[v];
        r_[v] -= along * q_[v];
        after += r_[v] * r_[v];
      }
      const double back = after / rr;
      rr = after;
      for (std::size_t v = 0; v < n; ++v) d_[v] = r_[v] + back * d_[v];
    }
    for (std::size_t v = 0; v < n; ++v) s[v] = held_[v] == not_held ? x_[v] * scale_[v] : held_[v];
  }

 private:
  /// y = A x for x that is 0 at held vertices, and y is put to 0 there.
  void multiply(const std::vector<double>& x, std::vector<double>& y) const {
    y = x;
    for (std::size_t k = 0; k < tris_.size(); ++k) {
      const auto [a, b, c] = tris_[k];
      const auto [ab, bc, ca] = weight_[k];
      y[a] -= ab * x[b] + ca * x[c];
      y[b] -= ab * x[a] + bc * x[c];
      y[c] -= bc * x[b] + ca * x[a];
    }
    for (std::size_t v = 0; v < y.size(); ++v)
      if (held_[v] != not_held) y[v] = 0;
  }

  const std::vector<Tri>& tris_;
  const std::vector<double>& held_;
  std::vector<std::array<double, 3>> weight_;  // of each triangle's edges
  std::vector<double> scale_;                  // one over the diagonal's root
  std::vector<double> x_, r_, d_, q_;          // scratch
};

}  // namespace

std::vector<double> threshold_dynamics(const Mesh& mesh, std::vector<double> sign,
                                       const std::vector<double>& time, const std::vector<double>& held,
                                       int steps) {
  const std::vector<Vec3>& p = mesh.points;
  std::vector<double> area, right(p.size()), mass(p.size(), 0), s(p.size(), 0);
  for (const Tri& v : mesh.tris) area.push_back(0.5 * norm(area_vector(p[v[0]], p[v[1]], p[v[2]])));
  HeatStep heat(mesh, area, time, held);
  for (std::size_t k = 0; k < sign.size(); ++k)
    for (int v : mesh.tris[k]) mass[v] += area[k] / 3;
  for (int step = 0; step < steps; ++step) {
    std::fill(right.begin(), right.end(), 0);
    for (std::size_t k = 0; k < sign.size(); ++k)
      for (int v : mesh.tris[k]) right[v] += area[k] / 3 * sign[k];
    if (step == 0)
      for (std::size_t v = 0; v < s.size(); ++v) s[v] = mass[v] > 0 ? right[v] / mass[v] : 0;
    heat.solve(right, s);
    for (std::size_t k = 0; k < sign.size(); ++k)
      sign[k] = mean_sign(s[mesh.tris[k][0]], s[mesh.tris[k][1]], s[mesh.tris[k][2]]);
  }
  return s;
}

}  // namespace meshpipe
