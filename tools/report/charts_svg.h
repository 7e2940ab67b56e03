// SPDX-License-Identifier: BSD-3-Clause
// All charts as an SVG picture.
#pragma once
#include <string>

#include "lib/core/chart.h"
#include "lib/param/param.h"

namespace meshpipe {

/// Returns all charts in rows as SVG, the highest first, each with part, map and distortion below. Triangles
/// are colored by the log of their area scale (plane over space): blue where the map shrinks, red where it
/// enlarges. `reports` has one entry per chart.
std::string charts_svg(const std::vector<Chart>& charts, const std::vector<ParamReport>& reports);

}  // namespace meshpipe
