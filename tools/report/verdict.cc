// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/report/histogram.h"

namespace meshpipe {
namespace {

std::string text(double x, int decimals) {
  if (std::isnan(x)) return "-";
  char s[40];
  if (decimals == short_figure)
    std::snprintf(s, sizeof s, "%.3g", x);
  else
    std::snprintf(s, sizeof s, "%.*f", decimals == count_figure ? 0 : decimals, x);
  return s;
}

std::string row(const std::string& label, const std::string& before, const std::string& after) {
  char s[120];
  std::snprintf(s, sizeof s, "%-26s %12s %12s", label.c_str(), before.c_str(), after.c_str());
  return s;
}

}  // namespace

std::vector<std::string> figure_table(const std::vector<Figure>& figures) {
  std::vector<std::string> lines{row("", "reference", "result")};
  for (const Figure& f : figures) {
    const bool always = f.key == "genus" || f.key == "loops" || f.key == "self_intersections";
    if (f.decimals == count_figure && !always && !(f.reference > 0) && !(f.result > 0)) continue;
    if (std::isnan(f.reference) && std::isnan(f.result)) continue;
    lines.push_back(row(f.label, text(f.reference, f.decimals), text(f.result, f.decimals)));
  }
  return lines;
}

std::string findings_svg(const Findings& f) {
  const auto &a = f.reference_quality.kappas, &b = f.quality.kappas;
  return histogram_svg(
      {{"kappa", 0, 1, bins(a, 0, 1, 50), bins(b, 0, 1, 50)},
       {"kappa, the smallest", 0, 0.1, bins(a, 0, 0.1, 20), bins(b, 0, 0.1, 20), (int)a.size(),
        (int)b.size()},
       {"smallest angle, degrees", 0, 60, f.reference_quality.angle_histogram, f.quality.angle_histogram}});
}

}  // namespace meshpipe
