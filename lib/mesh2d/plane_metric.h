// SPDX-License-Identifier: BSD-3-Clause
// The metric of a chart's map, in which plane lengths are lengths on the surface over the size asked for.
#pragma once
#include <vector>

#include "lib/core/chart.h"

namespace meshpipe {

/// The logarithm of a symmetric positive tensor [a b; b c]. Means and interpolation of metrics are linear in
/// it (Arsigny and others 2006), so that they never degenerate.
struct LogMetric {
  double a = 0, b = 0, c = 0;
};
inline LogMetric operator+(LogMetric x, LogMetric y) { return {x.a + y.a, x.b + y.b, x.c + y.c}; }
inline LogMetric operator*(double s, LogMetric x) { return {s * x.a, s * x.b, s * x.c}; }

/// The upper triangular factor F of a metric F^T F: maps the plane to where lengths are Euclidean.
struct MetricFactor {
  double xx = 1, xy = 0, yy = 1;
  Vec2 to(Vec2 d) const { return {xx * d.x + xy * d.y, yy * d.y}; }
  Vec2 back(Vec2 d) const { return {(d.x - xy / yy * d.y) / xx, d.y / yy}; }
};
/// Returns the factor of the metric with this logarithm.
MetricFactor factor_of(LogMetric log_metric);

/// Returns per vertex the metric J^T J of the chart's map (J = dx/du), averaged in log space over its
/// triangles, weighted by area.
std::vector<LogMetric> map_metric(const Chart& chart);

/// The place of a vertex of a plane mesh on the surface, with the size and metric there.
struct Site {
  Place place;
  Vec3 space;        ///< its point on the surface
  double size = 1;   ///< h there
  LogMetric metric;  ///< unit-edge metric M / h^2
};

/// Size and metric of a chart, linear on its triangles, the metric in log space.
class SizeMetric {
 public:
  SizeMetric(const Chart& chart, const std::vector<double>& size);  ///< keeps references
  SizeMetric(const SizeMetric& field, double factor) : SizeMetric(field) { factor_ *= factor; }  ///< on sizes
  const Chart& chart() const { return chart_; }
  Site at(const Place& place) const;
  Site at(Vec2 p, int hint) const { return at(locate(chart_, p, hint)); }
  /// Returns a bound on lengths in space over those in the plane, at vertices of the chart.
  double most_stretch() const;
  /// Returns the image of d in the plane, as far as it is tangent to triangle `face` of the chart.
  Vec2 to_plane(int face, Vec3 d) const;

 private:
  const Chart& chart_;
  const std::vector<double>& size_;
  std::vector<LogMetric> map_;
  double factor_ = 1;
};

}  // namespace meshpipe
