// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/curvature.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace meshpipe {
namespace {

constexpr int steps = 40;  ///< of diffusion: averages over about four triangles in each direction

/// A symmetric tensor (xx, xy, xz, yy, yz, zz) integrated over an area.
using Tensor = std::array<double, 6>;

/// The largest absolute eigenvalue of a symmetric tensor, by the trigonometric solution of its cubic (Smith
/// 1961).
double largest_eigenvalue(const Tensor& t) {
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
bool all_below(const std::vector<Tensor>& tensor, const std::vector<double>& area, double least) {
  bool above = false;
#pragma omp parallel for schedule(static) reduction(|| : above)
  for (std::size_t t = 0; t < tensor.size(); ++t) {
    const Tensor& m = tensor[t];
    const double square =
        m[0] * m[0] + m[3] * m[3] + m[5] * m[5] + 2 * (m[1] * m[1] + m[2] * m[2] + m[4] * m[4]);
    above = above || square > least * least * area[t] * area[t];
  }
  return !above;
}

/// What a step of diffusion passes on, per triangle and half-edge.
struct Shares {
  std::vector<double> kept, received;
};

/// Half of what a triangle has, divided among its neighbors by the lengths of its edges.
Shares shares_of(const Connectivity& surface) {
  const int n = surface.n_tris();
  std::vector<double> given(surface.n_half_edges(), 0);
  Shares shares{std::vector<double>(n), std::vector<double>(given.size(), 0)};
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t) {
    double length[3] = {0, 0, 0}, sum = 0;
    for (int i = 0; i < 3; ++i)
      if (const int h = 3 * t + i; !surface.is_border(h) && !surface.is_model(h))
        sum += length[i] = surface.length(h);
    for (int i = 0; i < 3; ++i) given[3 * t + i] = sum > 0 ? 0.5 * length[i] / sum : 0;
    shares.kept[t] = 1 - (given[3 * t] + given[3 * t + 1] + given[3 * t + 2]);
  }
#pragma omp parallel for schedule(static)
  for (int h = 0; h < (int)given.size(); ++h)
    if (given[h] != 0) shares.received[h] = given[surface.opposite[h]];
  return shares;
}

/// Half of the measure of each edge: its bend along it, over the square of its length.
std::vector<double> half_bends(const Connectivity& surface) {
  const int n = surface.n_half_edges();
  std::vector<double> half(n, 0);
#pragma omp parallel for schedule(static)
  for (int h = 0; h < n; ++h) {
    const int o = surface.opposite[h];
    if (o < h || surface.is_model(h)) continue;
    const Vec3 e = surface.point(surface.to(h)) - surface.point(surface.from(h));
    const double length = norm(e);
    if (!(length > 0)) continue;
    const Vec3 a = surface.area_vector(h / 3), b = surface.area_vector(o / 3);
    half[h] = half[o] = 0.5 * std::atan2(dot(cross(a, b), e) / length, dot(a, b)) / length;
  }
  return half;
}

}  // namespace

std::vector<double> face_curvature(const Connectivity& surface, double least) {
  const int n = surface.n_tris();
  std::vector<Tensor> now(n), then(n);
  std::vector<double> area(n), area_then(n);
  const std::vector<double> half = half_bends(surface);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t) {
    area[t] = 0.5 * norm(surface.area_vector(t));
    now[t] = {};
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (half[h] == 0) continue;
      const Vec3 e = surface.point(surface.to(h)) - surface.point(surface.from(h));
      const Tensor x = {e.x * e.x, e.x * e.y, e.x * e.z, e.y * e.y, e.y * e.z, e.z * e.z};
      for (int k = 0; k < 6; ++k) now[t][k] += half[h] * x[k];
    }
  }
  const Shares shares = shares_of(surface);
  for (int step = 0; step < steps; ++step) {
    // averages do not exceed the largest value: after 0, 1, 2, 4, ... steps
    if (least > 0 && std::popcount((unsigned)step) <= 1 && all_below(now, area, least)) break;
#pragma omp parallel for schedule(static)
    for (int t = 0; t < n; ++t) {
      Tensor sum;
      for (int k = 0; k < 6; ++k) sum[k] = shares.kept[t] * now[t][k];
      double a = shares.kept[t] * area[t];
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const double share = shares.received[h];
        if (share == 0) continue;
        const int other = surface.opposite[h] / 3;
        for (int k = 0; k < 6; ++k) sum[k] += share * now[other][k];
        a += share * area[other];
      }
      then[t] = sum, area_then[t] = a;
    }
    std::swap(now, then);
    std::swap(area, area_then);
  }
  std::vector<double> curvature(n, 0);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t)
    if (area[t] > 0) curvature[t] = largest_eigenvalue(now[t]) / area[t];
  return curvature;
}

}  // namespace meshpipe
