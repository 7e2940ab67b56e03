// SPDX-License-Identifier: BSD-3-Clause
// Charts as a drawing.
#pragma once
#include <string>

#include "lib/param.h"

namespace meshpipe {

/// An SVG document of all charts in rows, the largest first, each with its part, its map and its distortion
/// under it; triangles are coloured by the log of their area scale (plane over space), blue where the map
/// shrinks, red where it enlarges, over what the charts hold. Charts have the sizes of their parts.
/// reports: one entry a chart.
std::string charts_svg(const std::vector<Chart>& charts, const std::vector<ParamReport>& reports);

}  // namespace meshpipe
