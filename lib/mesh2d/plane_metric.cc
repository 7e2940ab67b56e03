// SPDX-License-Identifier: BSD-3-Clause
#include "lib/mesh2d/plane_metric.h"

#include <algorithm>
#include <cmath>

namespace meshpipe {
namespace {

// A triangle stretched more than this by the map (a needle of the input) counts as one stretched so much.
constexpr double most_stretch = 100;

LogMetric log_of(double a, double b, double c) {
  double m = 0.5 * (a + c), d = 0.5 * (a - c), r = std::hypot(d, b);
  double hi = m + r, lo = std::max((a * c - b * b) / hi, hi / (most_stretch * most_stretch));
  double log_hi = std::log(hi), log_lo = std::log(lo), mean = 0.5 * (log_hi + log_lo);
  double k = r > 0 ? 0.5 * (log_hi - log_lo) / r : 0;
  return {mean + k * d, k * b, mean - k * d};
}

}  // namespace

MetricFactor factor_of(LogMetric l) {
  // exp of the traceless part [d b; b -d], whose square is r^2 I, is cosh r I + sinh r / r [d b; b -d]
  double m = 0.5 * (l.a + l.c), d = 0.5 * (l.a - l.c), r = std::hypot(d, l.b);
  double e = std::exp(r), ch = 0.5 * (e + 1 / e), sh = r > 1e-8 ? 0.5 * (e - 1 / e) / r : 1;
  double root = std::exp(0.5 * m), p = std::sqrt(ch + sh * d);
  return {root * p, root * sh * l.b / p, root / p};
}

std::vector<LogMetric> map_metric(const Chart& chart) {
  std::vector<LogMetric> sum(chart.uv.size());
  std::vector<double> weight(chart.uv.size(), 0);
  for (const Tri& t : chart.mesh.tris) {
    Vec2 p = chart.uv[t[1]] - chart.uv[t[0]], q = chart.uv[t[2]] - chart.uv[t[0]];
    Vec3 x = chart.mesh.points[t[1]] - chart.mesh.points[t[0]],
         y = chart.mesh.points[t[2]] - chart.mesh.points[t[0]];
    double det = cross(p, q), area = norm(cross(x, y));
    if (!(det > 0) || !(area > 0)) continue;
    Vec3 xu = (1 / det) * (q.y * x - p.y * y), xv = (1 / det) * (p.x * y - q.x * x);
    double a = dot(xu, xu), b = dot(xu, xv), c = dot(xv, xv);
    if (!std::isfinite(a + c) || !(a + c > 0)) continue;
    LogMetric l = log_of(a, b, c);
    for (int v : t) {
      sum[v] = sum[v] + area * l;
      weight[v] += area;
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v)
    if (weight[v] > 0) sum[v] = (1 / weight[v]) * sum[v];
  return sum;
}

SizeMetric::SizeMetric(const Chart& chart, const std::vector<double>& size)
    : chart_(chart), size_(size), map_(map_metric(chart)) {}

double SizeMetric::most_stretch() const {
  double most = -infinity;
  for (const LogMetric& m : map_)
    most = std::max(most, 0.25 * (m.a + m.c) + 0.25 * std::abs(m.a - m.c) + 0.5 * std::abs(m.b));
  return std::exp(most);
}

Vec2 SizeMetric::to_plane(int face, Vec3 d) const {
  const Tri& t = chart_.mesh.tris[face];
  const auto& x = chart_.mesh.points;
  Vec3 e = x[t[1]] - x[t[0]], f = x[t[2]] - x[t[0]];
  double ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), de = dot(d, e), df = dot(d, f),
         det = ee * ff - ef * ef;
  return ((de * ff - df * ef) / det) * (chart_.uv[t[1]] - chart_.uv[t[0]]) +
         ((df * ee - de * ef) / det) * (chart_.uv[t[2]] - chart_.uv[t[0]]);
}

Site SizeMetric::at(const Place& p) const {
  const std::vector<Tri>& tris = chart_.mesh.tris;
  Site s{p, value_at(p, chart_.mesh.points, tris), factor_ * value_at(p, size_, tris),
         value_at(p, map_, tris)};
  double log_h2 = 2 * std::log(s.size);
  s.metric.a -= log_h2;
  s.metric.c -= log_h2;
  return s;
}

}  // namespace meshpipe
