// SPDX-License-Identifier: BSD-3-Clause
#include "formats/histogram.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace meshpipe {
namespace {

constexpr double left = 60, top = 20, width = 560, height = 300;

template <class... Args>
void print(std::string& out, const char* format, Args... args) {
  char line[400];
  std::snprintf(line, sizeof line, format, args...);
  out += line;
}

std::vector<double> shares(const std::vector<int>& counts) {
  const double total = std::max(1, std::accumulate(counts.begin(), counts.end(), 0));
  std::vector<double> s;
  for (int c : counts) s.push_back(100 * c / total);
  return s;
}

/// The outline of the bars, from the axis to the axis.
std::string outline(const std::vector<double>& share, double highest) {
  std::string path;
  print(path, "M%.1f %.1f", left, top + height);
  for (std::size_t i = 0; i < share.size(); ++i)
    print(path, "V%.1fH%.1f", top + height * (1 - share[i] / highest), left + width * (i + 1) / share.size());
  print(path, "V%.1fZ", top + height);
  return path;
}

}  // namespace

std::string kappa_histogram_svg(const std::vector<int>& before, const std::vector<int>& after) {
  const auto a = shares(before), b = shares(after);
  double highest = 1;
  for (const auto& s : {a, b})
    for (double x : s) highest = std::max(highest, x);
  // some four round marks
  double step = std::pow(10, std::floor(std::log10(highest / 4)));
  for (double factor : {5.0, 2.0})
    if (highest / (step * factor) >= 4) {
      step *= factor;
      break;
    }
  std::string out;
  print(out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" font-family=\"sans-serif\" "
        "font-size=\"13\">\n",
        left + width + 20, top + height + 50);
  out += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (double y = 0; y <= highest; y += step) {
    const double at = top + height * (1 - y / highest);
    print(out, "<path d=\"M%g %.1fH%g\" stroke=\"#ddd\"/>\n", left, at, left + width);
    print(out, "<text x=\"%g\" y=\"%.1f\" text-anchor=\"end\">%g %%</text>\n", left - 6, at + 4, y);
  }
  for (int i = 0; i <= 10; i += 2)
    print(out, "<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">%g</text>\n", left + width * i / 10,
          top + height + 18, i / 10.0);
  print(out, "<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">kappa</text>\n", left + width / 2,
        top + height + 38);
  out += "<path d=\"" + outline(b, highest) + "\" fill=\"#4c78a8\"/>\n";
  out += "<path d=\"" + outline(a, highest) + "\" fill=\"none\" stroke=\"#d95f02\" stroke-width=\"1.5\"/>\n";
  print(out, "<text x=\"%g\" y=\"%g\" fill=\"#d95f02\">reference</text>\n", left + 12, top + 16);
  print(out, "<text x=\"%g\" y=\"%g\" fill=\"#4c78a8\">result</text>\n</svg>\n", left + 12, top + 34);
  return out;
}

}  // namespace meshpipe
