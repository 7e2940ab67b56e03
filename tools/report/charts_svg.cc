// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/charts_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "tools/report/svg.h"

namespace meshpipe {
namespace {

constexpr int shades = 25;

struct Extent {
  Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
};

Extent box_of(const std::vector<Vec2>& uv) {
  Extent box;
  for (Vec2 p : uv) box.low = lower(box.low, p), box.high = upper(box.high, p);
  return box;
}

/// Rotates a chart so that the longer of its principal axes lies along x.
std::vector<Vec2> laid_flat(const std::vector<Vec2>& uv) {
  Vec2 mean;
  for (Vec2 p : uv) mean = mean + (1 / (double)uv.size()) * p;
  double xx = 0, xy = 0, yy = 0;
  for (Vec2 p : uv) {
    Vec2 d = p - mean;
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  double a = 0.5 * std::atan2(2 * xy, xx - yy), c = std::cos(a), s = std::sin(a);
  std::vector<Vec2> rotated;
  for (Vec2 p : uv) rotated.push_back({c * p.x + s * p.y, c * p.y - s * p.x});
  return rotated;
}

/// Returns the log of the area scale (plane over space) per triangle; 0 for triangles without area.
std::vector<double> log_scale(const Chart& chart) {
  std::vector<double> value;
  for (const Tri& t : chart.mesh.tris) {
    const auto& p = chart.mesh.points;
    double space = norm(area_vector(p[t[0]], p[t[1]], p[t[2]]));
    double plane = cross(chart.uv[t[1]] - chart.uv[t[0]], chart.uv[t[2]] - chart.uv[t[0]]);
    value.push_back(space > 0 && plane > 0 ? std::log(plane / space) : 0);
  }
  return value;
}

/// Returns a color from blue through white to red for 0 .. shades - 1.
std::string shade(int k) {
  double x = 2.0 * k / (shades - 1) - 1, pale = 1 - std::abs(x);
  int red = (int)std::lround(255 * (x > 0 ? 1 - 0.2 * x : 0.15 + 0.85 * pale));
  int green = (int)std::lround(255 * (0.15 + 0.85 * pale));
  int blue = (int)std::lround(255 * (x < 0 ? 1 + 0.2 * x : 0.15 + 0.85 * pale));
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", red, green, blue);
  return text;
}

constexpr double page_width = 1200, slot_gap = 16, caption = 44, least_slot = 330;  ///< units of the picture

/// A chart as it is drawn.
struct Drawing {
  std::vector<Vec2> uv;
  Extent box;
  std::vector<double> scale;  ///< log of the area scale per triangle

  explicit Drawing(const Chart& chart) : uv(laid_flat(chart.uv)), box(box_of(uv)), scale(log_scale(chart)) {}
  double width() const { return box.high.x - box.low.x; }
  double height() const { return box.high.y - box.low.y; }
};

/// Returns the largest log of the area scale that has a color of its own: that of 98 triangles of 100, at
/// least a factor of 2.
double color_range(const std::vector<Drawing>& drawings) {
  std::vector<double> all;
  for (const Drawing& d : drawings) all.insert(all.end(), d.scale.begin(), d.scale.end());
  const double least = std::log(2.0);
  if (all.empty()) return least;
  std::sort(all.begin(), all.end());
  const std::size_t cut = all.size() / 100;
  return std::max({least, std::abs(all[cut]), std::abs(all[all.size() - 1 - cut])});
}

/// Draws the triangles of a chart at a corner, one path per color.
void draw_triangles(Svg& svg, const Drawing& d, const Chart& chart, Vec2 corner, double unit, double range) {
  std::array<SvgPath, shades> path;
  for (std::size_t t = 0; t < d.scale.size(); ++t) {
    const double v = 0.5 + 0.5 * std::clamp(d.scale[t] / range, -1.0, 1.0);
    SvgPath& p = path[static_cast<std::size_t>(std::lround(v * (shades - 1)))];
    for (int i = 0; i < 3; ++i) {
      const Vec2 q = d.uv[chart.mesh.tris[t][i]];
      const Vec2 at = corner + unit * Vec2{q.x - d.box.low.x, d.box.high.y - q.y};
      if (i == 0)
        p.move_to(at);
      else
        p.line_to(at);
    }
    p.close();
  }
  // lines as thin as the triangles are small
  const double edge = unit * std::sqrt(d.width() * d.height() /
                                       static_cast<double>(std::max<std::size_t>(1, d.scale.size())));
  svg.begin_group("stroke=\"#000\" stroke-opacity=\"0.5\" stroke-linejoin=\"round\" " +
                  svg_number("stroke-width", std::clamp(0.06 * edge, 0.01, 0.6)));
  for (int k = 0; k < shades; ++k) svg.path(path[k], "fill=\"" + shade(k) + '"');
  svg.end_group();
}

void draw_caption(Svg& svg, int chart, const ParamReport& r, std::size_t triangles, Vec2 at) {
  const char* name = r.used == MapKind::conformal  ? "conformal"
                     : r.used == MapKind::harmonic ? "harmonic"
                                                   : "convex";
  char text[200];
  std::snprintf(text, sizeof text, "part %d: %zu triangles, %s map", chart, triangles, name);
  svg.text(at, text);
  std::snprintf(text, sizeof text, "sigma1/sigma2 median %.3g, p99 %.3g; area scale p99/p1 %.3g",
                r.anisotropy_median, r.anisotropy_p99, r.area_scale);
  svg.text(at + Vec2{0, 16}, text);
}

}  // namespace

std::string charts_svg(const std::vector<Chart>& charts, const std::vector<ParamReport>& reports) {
  std::vector<Drawing> drawings;
  double widest = 0, area = 0;
  for (const Chart& chart : charts) {
    drawings.emplace_back(chart);
    widest = std::max(widest, drawings.back().width());
    area += drawings.back().width() * drawings.back().height();
  }
  const double range = color_range(drawings);
  const double unit =
      std::min(0.48 * (page_width - 2 * slot_gap) / widest, 0.8 * page_width / std::sqrt(area));
  std::vector<int> order = identity(charts.size());
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return drawings[a].height() > drawings[b].height(); });

  std::vector<Vec2> corner(charts.size());
  double x = slot_gap, y = slot_gap, row = 0;
  for (int c : order) {
    const double slot = std::max(unit * drawings[c].width(), least_slot);
    if (x > slot_gap && x + slot + slot_gap > page_width)
      x = slot_gap, y += row + caption + slot_gap, row = 0;
    row = std::max(row, unit * drawings[c].height());
    corner[c] = {x, y};
    x += slot + slot_gap;
  }
  constexpr double swatch = 12;
  const double key = y + row + caption + 2 * slot_gap;
  Svg svg(page_width, key + swatch + slot_gap, "font-family=\"sans-serif\" font-size=\"13\"", true);
  for (int c : order) {
    draw_triangles(svg, drawings[c], charts[c], corner[c], unit, range);
    draw_caption(svg, c, reports[c], drawings[c].scale.size(),
                 corner[c] + Vec2{0, unit * drawings[c].height() + 18});
  }
  for (int k = 0; k < shades; ++k)
    svg.rectangle({slot_gap + swatch * k, key}, {swatch, swatch}, "fill=\"" + shade(k) + '"');
  svg.text({slot_gap + swatch * shades + 10, key + 11},
           "area scale 1/" + shown(std::exp(range)) + " to " + shown(std::exp(range)));
  return svg.finish();
}

}  // namespace meshpipe
