// SPDX-License-Identifier: BSD-3-Clause
// A histogram as an SVG picture.
#pragma once
#include <string>
#include <vector>

namespace meshpipe {

/// Shares of the triangles by kappa, before (outlined) and after (filled), over equal bins of [0, 1].
std::string kappa_histogram_svg(const std::vector<int>& before, const std::vector<int>& after);

}  // namespace meshpipe
