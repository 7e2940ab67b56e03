// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/curvature.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace meshpipe {
namespace {

constexpr int steps = 40;  ///< of diffusion: averages over about four triangles in each direction

/// A symmetric tensor (xx, xy, xz, yy, yz, zz) integrated over an area, and the area.
struct Measure {
  double m[7] = {0, 0, 0, 0, 0, 0, 0};
};

/// The largest absolute eigenvalue of a symmetric tensor, by the trigonometric solution of its cubic (Smith
/// 1961).
double largest_eigenvalue(const double* t) {
  const double mean = (t[0] + t[3] + t[5]) / 3, a = t[0] - mean, b = t[3] - mean, c = t[5] - mean;
  const double p = std::sqrt((a * a + b * b + c * c + 2 * (t[1] * t[1] + t[2] * t[2] + t[4] * t[4])) / 6);
  if (!(p > 0)) return std::abs(mean);
  const double det =
      a * (b * c - t[4] * t[4]) - t[1] * (t[1] * c - t[4] * t[2]) + t[2] * (t[1] * t[4] - b * t[2]);
  const double cosine = std::clamp(det / (2 * p * p * p), -1.0, 1.0);
  const double phi = std::atan2(std::sqrt(1 - cosine * cosine), cosine) / 3;
  const double third = 2 * std::numbers::pi / 3;
  return std::max(std::abs(mean + 2 * p * std::cos(phi)), std::abs(mean + 2 * p * std::cos(phi + third)));
}

/// Is the Frobenius norm of every tensor over its area, which bounds the eigenvalues, at most `least`?
bool all_below(const std::vector<Measure>& now, double least) {
  bool above = false;
#pragma omp parallel for schedule(static) reduction(|| : above)
  for (std::size_t t = 0; t < now.size(); ++t) {
    const double* m = now[t].m;
    const double square =
        m[0] * m[0] + m[3] * m[3] + m[5] * m[5] + 2 * (m[1] * m[1] + m[2] * m[2] + m[4] * m[4]);
    above = above || square > least * least * m[6] * m[6];
  }
  return !above;
}

}  // namespace

std::vector<double> face_curvature(const Connectivity& surface, double least) {
  const std::vector<int>& opposite = surface.opposite;
  const int n = surface.n_tris();
  std::vector<Vec3> area(n);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t) area[t] = surface.area_vector(t);

  std::vector<Measure> now(n), then(n);
  std::vector<double> share(3 * static_cast<std::size_t>(n), 0);  // of a triangle's measure, over each edge
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t) {
    double length[3] = {0, 0, 0}, sum = 0;
    double* m = now[t].m;
    for (int i = 0; i < 3; ++i) {
      const int h = 3 * t + i;
      if (surface.is_border(h) || surface.is_model(h)) continue;
      const Vec3 e = surface.point(surface.to(h)) - surface.point(surface.from(h));
      length[i] = norm(e);
      sum += length[i];
      if (!(length[i] > 0)) continue;
      const Vec3 turn = cross(area[t], area[opposite[h] / 3]);
      const double bend = std::atan2(dot(turn, e) / length[i], dot(area[t], area[opposite[h] / 3]));
      const double w = 0.5 * bend / length[i];  // half the edge's measure; the other triangle has the rest
      const double x[6] = {e.x * e.x, e.x * e.y, e.x * e.z, e.y * e.y, e.y * e.z, e.z * e.z};
      for (int k = 0; k < 6; ++k) m[k] += w * x[k];
    }
    m[6] = 0.5 * norm(area[t]);
    for (int i = 0; i < 3; ++i) share[3 * t + i] = sum > 0 ? 0.5 * length[i] / sum : 0;
  }
  for (int step = 0; step < steps; ++step) {
    // averages do not exceed the largest value: after 0, 1, 2, 4, ... steps
    if (least > 0 && std::popcount((unsigned)step) <= 1 && all_below(now, least)) break;
#pragma omp parallel for schedule(static)
    for (int t = 0; t < n; ++t) {
      const double kept = 1 - (share[3 * t] + share[3 * t + 1] + share[3 * t + 2]);
      Measure sum;
      for (int k = 0; k < 7; ++k) sum.m[k] = kept * now[t].m[k];
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        if (share[h] == 0) continue;
        const Measure& other = now[opposite[h] / 3];
        for (int k = 0; k < 7; ++k) sum.m[k] += share[opposite[h]] * other.m[k];
      }
      then[t] = sum;
    }
    std::swap(now, then);
  }
  std::vector<double> curvature(n, 0);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t)
    if (now[t].m[6] > 0) curvature[t] = largest_eigenvalue(now[t].m) / now[t].m[6];
  return curvature;
}

}  // namespace meshpipe
