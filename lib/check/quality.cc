// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace meshpipe {
namespace {

constexpr double to_degrees = 180 / std::numbers::pi;
constexpr int chunk = 4096;  // triangles; sums are taken by chunks, so that they do not depend on the threads

/// Shapes of the triangles of one chunk.
struct Shapes {
  double kappa_sum = 0, angle_sum = 0, min_angle = 180, max_angle = 0;
  std::array<int, 60> angles{};
};

/// kappa as 8 A^2 / (s a b c), the same number as the paper's eq. (6) without trigonometry; of the angles
/// only those at the ends of the shortest and the longest side are asked for.
Shapes shapes(const Mesh& mesh, int first, int last, std::vector<float>& kappas) {
  Shapes s;
  double cotangent = 1e300;  // of the largest angle; it falls as the angle grows
  for (int t = first; t < last; ++t) {
    const Vec3 &a = mesh.points[mesh.tris[t][0]], &b = mesh.points[mesh.tris[t][1]],
               &c = mesh.points[mesh.tris[t][2]];
    const Vec3 x = c - b, y = a - c, z = b - a;
    const double xx = dot(x, x), yy = dot(y, y), zz = dot(z, z), n = norm(cross(y, z));
    const double p = std::sqrt(xx), q = std::sqrt(yy), r = std::sqrt(zz), d = p * q * r * (p + q + r);
    const double k = d > 0 ? 4 * n * n / d : 0;
    kappas[t] = (float)k;
    s.kappa_sum += k;
    const double shortest = std::min({xx, yy, zz}), longest = std::max({xx, yy, zz}), all = xx + yy + zz;
    const double least = std::atan2(2 * n, all - 2 * shortest) * to_degrees;  // dot = (all - 2 l^2) / 2
    s.angle_sum += least;
    s.min_angle = std::min(s.min_angle, least);
    ++s.angles[std::clamp((int)least, 0, 59)];
    if (n > 0)
      cotangent = std::min(cotangent, (all - 2 * longest) / (2 * n));
    else
      s.max_angle = 180;
  }
  s.max_angle = std::max(s.max_angle, std::atan2(1, cotangent) * to_degrees);
  return s;
}

/// Sums over edge lengths.
struct Lengths {
  double sum = 0, squares = 0, least = 1e300, largest = 0;
  int count = 0;

  void add(const Lengths& l) {
    sum += l.sum, squares += l.squares, count += l.count;
    least = std::min(least, l.least), largest = std::max(largest, l.largest);
  }
};

/// Sums the lengths of the edges of one chunk's triangles, each edge with the larger of its half-edges.
Lengths lengths(const Connectivity& c, const std::vector<double>& size, int first, int last) {
  Lengths l;
  for (int h = 3 * first; h < 3 * last; ++h) {
    if (c.opposite[h] > h) continue;
    double x = c.length(h);
    if (!size.empty()) x *= 2 / (size[c.from(h)] + size[c.to(h)]);
    l.add({x, x * x, x, x, 1});
  }
  return l;
}

/// Returns the share of the inner vertices with 5, 6 or 7 neighbors; 1 without inner vertices.
double share_of_valence567(const Connectivity& c) {
  std::vector<int> valence(c.n_vertices(), 0);
  constexpr int border = 1 << 28;
  for (int h = 0; h < c.n_half_edges(); ++h) {
    ++valence[c.from(h)];
    if (c.is_border(h)) valence[c.from(h)] |= border, valence[c.to(h)] |= border;
  }
  int inner = 0, good = 0;
  for (int v : valence)
    if (v > 0 && v < border) {
      ++inner;
      good += v >= 5 && v <= 7;
    }
  return inner ? (double)good / inner : 1;
}

}  // namespace

Quality quality_of(const Connectivity& surface, const std::vector<double>& size) {
  const Mesh& mesh = surface.mesh;
  Quality q;
  q.angle_histogram.assign(60, 0);
  const int n = (int)mesh.tris.size(), chunks = (n + chunk - 1) / chunk;
  if (n == 0) return q;
  q.kappas.resize(n);
  std::vector<Shapes> shape(chunks);
  std::vector<Lengths> length(chunks);
#pragma omp parallel for schedule(dynamic) if (chunks > 1)
  for (int k = 0; k < chunks; ++k) {
    const int first = k * chunk, last = std::min(n, first + chunk);
    shape[k] = shapes(mesh, first, last, q.kappas);
    length[k] = lengths(surface, size, first, last);
  }
  q.min_angle = 180;
  for (const Shapes& s : shape) {
    q.kappa_mean += s.kappa_sum / n;
    q.mean_min_angle += s.angle_sum / n;
    q.min_angle = std::min(q.min_angle, s.min_angle);
    q.max_angle = std::max(q.max_angle, s.max_angle);
    for (int i = 0; i < 60; ++i) q.angle_histogram[i] += s.angles[i];
  }
  q.worst = (int)(std::min_element(q.kappas.begin(), q.kappas.end()) - q.kappas.begin());
  const Tri& w = mesh.tris[q.worst];
  q.kappa_min = kappa(mesh.points[w[0]], mesh.points[w[1]], mesh.points[w[2]]);
  std::vector<float> sorted = q.kappas;
  std::nth_element(sorted.begin(), sorted.begin() + n / 100, sorted.end());
  q.kappa_p01 = sorted[n / 100];

  Lengths all;
  for (const Lengths& l : length) all.add(l);
  const double mean = all.sum / all.count, unit = size.empty() && mean > 0 ? mean : 1;
  q.edge_min = all.least / unit;
  q.edge_max = all.largest / unit;
  q.edge_mean = mean / unit;
  q.edge_deviation = std::sqrt(std::max(0.0, all.squares / all.count - mean * mean)) / unit;

  q.valence567 = share_of_valence567(surface);
  return q;
}

std::vector<int> bins(std::span<const float> values, double low, double high, int n) {
  std::vector<int> counts(n, 0);
  for (float x : values)
    if (x >= low && x <= high) ++counts[std::min(n - 1, (int)(n * (x - low) / (high - low)))];
  return counts;
}

}  // namespace meshpipe
