// SPDX-License-Identifier: BSD-3-Clause
#include "formats/histogram.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace meshpipe {
namespace {

constexpr double left = 60, top = 34, width = 420, height = 300, panel_width = left + width + 20;

template <class... Args>
void print(std::string& out, const char* format, Args... args) {
  char line[400];
  std::snprintf(line, sizeof line, format, args...);
  out += line;
}

std::vector<double> shares(const std::vector<int>& counts, int all) {
  if (all == 0) all = std::accumulate(counts.begin(), counts.end(), 0);
  std::vector<double> s;
  for (int c : counts) s.push_back(100.0 * c / std::max(1, all));
  return s;
}

/// The outline of the bars, from the axis to the axis.
std::string outline(const std::vector<double>& share, double x0, double highest) {
  std::string path;
  print(path, "M%.1f %.1f", x0, top + height);
  for (std::size_t i = 0; i < share.size(); ++i)
    print(path, "V%.1fH%.1f", top + height * (1 - share[i] / highest), x0 + width * (i + 1) / share.size());
  print(path, "V%.1fZ", top + height);
  return path;
}

/// A round step that gives some four marks up to `highest`.
double mark_step(double highest) {
  const double step = std::pow(10, std::floor(std::log10(highest / 4)));
  for (double factor : {5.0, 2.0})
    if (highest / (step * factor) >= 4) return step * factor;
  return step;
}

void draw(std::string& out, const Panel& panel, double x0) {
  const auto a = shares(panel.before, panel.all_before), b = shares(panel.after, panel.all_after);
  double highest = 1e-3;
  for (const auto& s : {a, b})
    for (double x : s) highest = std::max(highest, x);
  const double step = mark_step(highest);
  for (int i = 0; i * step <= highest; ++i) {
    const double y = top + height * (1 - i * step / highest);
    print(out, "<path d=\"M%g %.1fH%g\" stroke=\"#ddd\"/>\n", x0, y, x0 + width);
    print(out, "<text x=\"%g\" y=\"%.1f\" text-anchor=\"end\">%g %%</text>\n", x0 - 6, y + 4, i * step);
  }
  for (int i = 0; i <= 4; ++i)
    print(out, "<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">%g</text>\n", x0 + width * i / 4,
          top + height + 18, panel.low + (panel.high - panel.low) * i / 4);
  print(out, "<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">%s</text>\n", x0 + width / 2, top - 14,
        panel.title.c_str());
  out += "<path d=\"" + outline(b, x0, highest) + "\" fill=\"#4c78a8\"/>\n";
  out +=
      "<path d=\"" + outline(a, x0, highest) + "\" fill=\"none\" stroke=\"#d95f02\" stroke-width=\"1.5\"/>\n";
}

}  // namespace

std::string histogram_svg(const std::vector<Panel>& panels) {
  std::string out;
  print(out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" font-family=\"sans-serif\" "
        "font-size=\"13\">\n",
        panel_width * panels.size(), top + height + 50);
  out += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (std::size_t i = 0; i < panels.size(); ++i) draw(out, panels[i], left + panel_width * i);
  print(out, "<text x=\"%g\" y=\"%g\" fill=\"#d95f02\">reference</text>\n", left, top + height + 40);
  print(out, "<text x=\"%g\" y=\"%g\" fill=\"#4c78a8\">result</text>\n</svg>\n", left + 80,
        top + height + 40);
  return out;
}

}  // namespace meshpipe
