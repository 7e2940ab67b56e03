// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/curvature.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "lib/core/lists.h"

namespace meshpipe {
namespace {

constexpr int steps = 25;       ///< of diffusion: averages over about four triangles in each direction
constexpr float passed = 0.8f;  ///< of what a triangle has, in a step
constexpr int few = 100;        ///< times as many triangles: their neighborhoods are not all of the surface

using Four = float __attribute__((vector_size(16)));

/// A symmetric tensor integrated over an area (xx, yy, zz, the area; xy, xz, yz, nothing), in diagonals.
struct Moments {
  Four even, odd;
};

/// The largest absolute eigenvalue of a symmetric tensor, by the trigonometric solution of its cubic (Smith
/// 1961).
double largest_eigenvalue(const Moments& t) {
  const double mean = ((double)t.even[0] + t.even[1] + t.even[2]) / 3, a = t.even[0] - mean,
               b = t.even[1] - mean, c = t.even[2] - mean, xy = t.odd[0], xz = t.odd[1], yz = t.odd[2];
  const double p = std::sqrt((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6);
  if (!(p > 0)) return std::abs(mean);
  const double det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
  const double cosine = std::clamp(det / (2 * p * p * p), -1.0, 1.0);
  const double phi = std::atan2(std::sqrt(1 - cosine * cosine), cosine) / 3;
  const double third = 2 * std::numbers::pi / 3;
  return std::max(std::abs(mean + 2 * p * std::cos(phi)), std::abs(mean + 2 * p * std::cos(phi + third)));
}

/// Returns those of the triangles whose tensor over its area is more than `least` in the Frobenius norm,
/// which bounds the eigenvalues.
std::vector<int> above(const std::vector<Moments>& moments, const std::vector<int>& tris, double least) {
  std::vector<int> found;
  for (int t : tris) {
    const Moments& m = moments[t];
    double square = 0;
    for (int k = 0; k < 3; ++k) square += (double)m.even[k] * m.even[k] + 2.0 * m.odd[k] * m.odd[k];
    if (square > least * least * m.even[3] * m.even[3]) found.push_back(t);
  }
  return found;
}

/// Returns the triangles at most `rings` steps across edges away from the given ones, in order.
std::vector<int> within(const std::vector<int>& opposite, std::vector<int> tris, int rings) {
  std::vector<char> seen(opposite.size() / 3, 0);
  for (int t : tris) seen[t] = 1;
  for (std::size_t first = 0; rings > 0; --rings)
    for (const std::size_t last = tris.size(); first < last; ++first)
      for (int h = 3 * tris[first]; h < 3 * tris[first] + 3; ++h)
        if (const int u = opposite[h] / 3; opposite[h] >= 0 && !seen[u]) seen[u] = 1, tris.push_back(u);
  tris.clear();
  for (int t = 0; t < (int)seen.size(); ++t)
    if (seen[t]) tris.push_back(t);
  return tris;
}

/// What a triangle passes on in a step of diffusion, per half-edge: divided by the lengths of its edges.
std::vector<float> shares_of(const Connectivity& surface) {
  std::vector<float> given(surface.n_half_edges(), 0);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < surface.n_tris(); ++t) {
    double length[3] = {0, 0, 0}, sum = 0;
    for (int i = 0; i < 3; ++i)
      if (const int h = 3 * t + i; !surface.is_border(h) && !surface.is_model(h))
        sum += length[i] = surface.length(h);
    for (int i = 0; i < 3; ++i) given[3 * t + i] = sum > 0 ? passed * (float)(length[i] / sum) : 0;
  }
  return given;
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
  const double unit = diagonal(surface.mesh);
  std::vector<Moments> now(n), then(n);
  const std::vector<double> half = half_bends(surface);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t) {
    double m[6] = {};
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (half[h] == 0) continue;
      const Vec3 e = surface.point(surface.to(h)) - surface.point(surface.from(h));
      const double x[6] = {e.x * e.x, e.y * e.y, e.z * e.z, e.x * e.y, e.x * e.z, e.y * e.z};
      for (int k = 0; k < 6; ++k) m[k] += half[h] / unit * x[k];
    }
    const double area = 0.5 * norm(surface.area_vector(t)) / unit / unit;
    now[t] = {Four{(float)m[0], (float)m[1], (float)m[2], (float)area},
              Four{(float)m[3], (float)m[4], (float)m[5], 0}};
  }
  const std::vector<float> given = shares_of(surface);
  std::vector<int> active = identity(n);
  for (int step = 0; step < steps; ++step) {
    // averages do not exceed the largest value: after 0, 1, 2, 4, ... steps. What is above near the end comes
    // from what is above now, and depends on what is as near to that
    if (least > 0 && std::popcount((unsigned)step) <= 1) {
      const std::vector<int> large = above(now, active, least * unit);
      if ((int)large.size() < n / few)
        active = within(surface.opposite, large, 2 * (steps - step)), then = now;
      if (active.empty()) break;
    }
#pragma omp parallel for schedule(static)
    for (int t : active) {
      const float kept = 1 - (given[3 * t] + given[3 * t + 1] + given[3 * t + 2]);
      Moments sum{kept * now[t].even, kept * now[t].odd};
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = surface.opposite[h];
        if (o < 0) continue;
        sum.even += given[o] * now[o / 3].even;
        sum.odd += given[o] * now[o / 3].odd;
      }
      then[t] = sum;
    }
    std::swap(now, then);
  }
  std::vector<double> curvature(n, least);
#pragma omp parallel for schedule(static)
  for (int t : active)
    if (const double area = now[t].even[3]; area > 0) curvature[t] = largest_eigenvalue(now[t]) / area / unit;
  return curvature;
}

}  // namespace meshpipe
