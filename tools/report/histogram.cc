// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/histogram.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lib/core/number.h"
#include "tools/report/svg.h"

namespace meshpipe {
namespace {

constexpr double left = 60, top = 34, width = 420, height = 300, panel_width = left + width + 20;

std::vector<double> shares(const std::vector<int>& counts, int all) {
  if (all == 0) all = std::accumulate(counts.begin(), counts.end(), 0);
  std::vector<double> s;
  for (int c : counts) s.push_back(100.0 * c / std::max(1, all));
  return s;
}

/// Returns the outline of the bars, from the axis to the axis.
SvgPath outline(const std::vector<double>& share, double x0, double highest) {
  SvgPath path;
  const double axis = top + height;
  path.move_to({x0, axis});
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double y = axis - height * share[i] / highest, n = static_cast<double>(share.size());
    path.line_to({x0 + width * static_cast<double>(i) / n, y});
    path.line_to({x0 + width * static_cast<double>(i + 1) / n, y});
  }
  path.line_to({x0 + width, axis});
  path.close();
  return path;
}

/// Returns a step of 1, 2 or 5 times a power of ten that gives four marks or more up to `highest`.
double mark_step(double highest) {
  const double step = std::pow(10, std::floor(std::log10(highest / 4)));
  for (double factor : {5.0, 2.0})
    if (highest / (step * factor) >= 4) return step * factor;
  return step;
}

void draw(Svg& svg, const Panel& panel, double x0) {
  const auto a = shares(panel.before, panel.all_before), b = shares(panel.after, panel.all_after);
  double highest = 1e-3;  // percent
  for (const auto& s : {a, b})
    for (double x : s) highest = std::max(highest, x);
  const double step = mark_step(highest);
  const char* const centered = "text-anchor=\"middle\"";
  for (int i = 0; i * step <= highest; ++i) {
    const double y = top + height * (1 - i * step / highest);
    SvgPath mark;
    mark.move_to({x0, y});
    mark.line_to({x0 + width, y});
    svg.path(mark, "stroke=\"#ddd\"");
    svg.text({x0 - 6, y + 4}, shown(i * step) + " %", "text-anchor=\"end\"");
  }
  for (int i = 0; i <= 4; ++i)
    svg.text({x0 + width * i / 4, top + height + 18}, shown(panel.low + (panel.high - panel.low) * i / 4),
             centered);
  svg.text({x0 + width / 2, top - 14}, panel.title, centered);
  svg.path(outline(b, x0, highest), "fill=\"#4c78a8\"");
  svg.path(outline(a, x0, highest), "fill=\"none\" stroke=\"#d95f02\" stroke-width=\"1.5\"");
}

}  // namespace

std::string histogram_svg(const std::vector<Panel>& panels) {
  Svg svg(panel_width * static_cast<double>(panels.size()), top + height + 50,
          "font-family=\"sans-serif\" font-size=\"13\"");
  for (std::size_t i = 0; i < panels.size(); ++i)
    draw(svg, panels[i], left + panel_width * static_cast<double>(i));
  svg.text({left, top + height + 40}, "reference", "fill=\"#d95f02\"");
  svg.text({left + 80, top + height + 40}, "result", "fill=\"#4c78a8\"");
  return svg.finish();
}

}  // namespace meshpipe
