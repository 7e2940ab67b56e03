// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param_svg.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "lib/number.h"

namespace meshpipe {
namespace {

constexpr int shades = 25;

struct Box {
  Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
};

Box box_of(const std::vector<Vec2>& uv) {
  Box box;
  for (Vec2 p : uv) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

/// Turned so that the longer direction of its principal axes lies along x.
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
  std::vector<Vec2> turned;
  for (Vec2 p : uv) turned.push_back({c * p.x + s * p.y, c * p.y - s * p.x});
  return turned;
}

/// The log of the area scale of every triangle; 0 for those without area in space.
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

/// Blue over white to red for 0 .. shades - 1.
std::string shade(int k) {
  double x = 2.0 * k / (shades - 1) - 1, pale = 1 - std::abs(x);
  int red = (int)std::lround(255 * (x > 0 ? 1 - 0.2 * x : 0.15 + 0.85 * pale));
  int green = (int)std::lround(255 * (0.15 + 0.85 * pale));
  int blue = (int)std::lround(255 * (x < 0 ? 1 + 0.2 * x : 0.15 + 0.85 * pale));
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", red, green, blue);
  return text;
}

}  // namespace

std::string charts_svg(const std::vector<Chart>& charts, const std::vector<ParamReport>& reports) {
  constexpr double width = 1200, gap = 16, caption = 44;
  std::vector<std::vector<Vec2>> uv;
  std::vector<Box> box;
  std::vector<std::vector<double>> scale;
  std::vector<double> all;
  double widest = 0, area = 0;
  for (const Chart& chart : charts) {
    uv.push_back(laid_flat(chart.uv));
    box.push_back(box_of(uv.back()));
    scale.push_back(log_scale(chart));
    all.insert(all.end(), scale.back().begin(), scale.back().end());
    widest = std::max(widest, box.back().high.x - box.back().low.x);
    area += (box.back().high.x - box.back().low.x) * (box.back().high.y - box.back().low.y);
  }
  // colours: symmetric about 1, up to what 98 triangles of 100 keep to, at least a factor of 2
  double range = std::log(2.0);
  if (!all.empty()) {
    std::sort(all.begin(), all.end());
    std::size_t cut = all.size() / 100;
    range = std::max({range, std::abs(all[cut]), std::abs(all[all.size() - 1 - cut])});
  }
  double unit = std::min(0.48 * (width - 2 * gap) / widest, 0.8 * width / std::sqrt(area));

  std::vector<int> order(charts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return box[a].high.y - box[a].low.y > box[b].high.y - box[b].low.y; });
  std::string body;
  double x = gap, y = gap, row = 0;
  for (int c : order) {
    double w = unit * (box[c].high.x - box[c].low.x), h = unit * (box[c].high.y - box[c].low.y);
    double cell = std::max(w, 330.0);
    if (x > gap && x + cell + gap > width) x = gap, y += row + caption + gap, row = 0;
    row = std::max(row, h);
    // one path a shade
    std::array<std::string, shades> path;
    for (std::size_t t = 0; t < scale[c].size(); ++t) {
      double v = 0.5 + 0.5 * std::clamp(scale[c][t] / range, -1.0, 1.0);
      std::string& p = path[(int)std::lround(v * (shades - 1))];
      for (int i = 0; i < 3; ++i) {
        Vec2 q = uv[c][charts[c].mesh.tris[t][i]];
        p += i == 0 ? 'M' : i == 1 ? 'L' : ' ';
        p += shown(x + unit * (q.x - box[c].low.x));
        p += ' ';
        p += shown(y + unit * (box[c].high.y - q.y));
      }
      p += "z";
    }
    // lines as thin as the triangles are small
    double edge = unit * std::sqrt((box[c].high.x - box[c].low.x) * (box[c].high.y - box[c].low.y) /
                                   (double)std::max<std::size_t>(1, scale[c].size()));
    body += "<g stroke=\"#000\" stroke-opacity=\"0.5\" stroke-width=\"" +
            shown(std::clamp(0.06 * edge, 0.01, 0.6)) + "\" stroke-linejoin=\"round\">\n";
    for (int k = 0; k < shades; ++k)
      if (!path[k].empty()) body += "<path fill=\"" + shade(k) + "\" d=\"" + path[k] + "\"/>\n";
    body += "</g>\n";
    const ParamReport& r = reports[c];
    const char* name = r.used == MapKind::conformal  ? "conformal"
                       : r.used == MapKind::harmonic ? "harmonic"
                                                     : "convex";
    char text[400];
    std::snprintf(
        text, sizeof text,
        "<text x=\"%.6g\" y=\"%.6g\">part %d: %zu triangles, %s map</text>\n"
        "<text x=\"%.6g\" y=\"%.6g\">sigma1/sigma2 median %.3g, p99 %.3g; area scale p99/p1 %.3g</text>\n",
        x, y + h + 18, c, scale[c].size(), name, x, y + h + 34, r.anisotropy_median, r.anisotropy_p99,
        r.area_scale);
    body += text;
    x += cell + gap;
  }
  double height = y + row + caption + 2 * gap;
  std::string key;
  for (int k = 0; k < shades; ++k)
    key += "<rect x=\"" + shown(gap + 12 * k) + "\" y=\"" + shown(height) +
           "\" width=\"12\" height=\"12\" fill=\"" + shade(k) + "\"/>\n";
  key += "<text x=\"" + shown(gap + 12 * shades + 10) + "\" y=\"" + shown(height + 11) + "\">area scale 1/" +
         shown(std::exp(range)) + " to " + shown(std::exp(range)) + "</text>\n";
  height += 12 + gap;
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + shown(width) + "\" height=\"" +
         shown(height) + "\" viewBox=\"0 0 " + shown(width) + " " + shown(height) +
         "\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"#fff\"/>\n" +
         body + key + "</svg>\n";
}

}  // namespace meshpipe
