// SPDX-License-Identifier: BSD-3-Clause
// Histograms as an SVG picture.
#pragma once
#include <string>
#include <vector>

namespace meshpipe {

/// Counts over equal parts of [low, high], and the number of values that are 100 % (0: the sum of counts).
struct Panel {
  std::string title;
  double low, high;
  std::vector<int> before, after;
  int all_before = 0, all_after = 0;
};

/// Returns the panels side by side: shares before (outlined) and after (filled), in percent.
std::string histogram_svg(const std::vector<Panel>& panels);

}  // namespace meshpipe
