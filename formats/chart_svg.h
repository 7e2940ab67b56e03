// SPDX-License-Identifier: BSD-3-Clause
// A chart as an SVG picture: the map of the surface's triangles and the mesh made on it, side by side.
#pragma once
#include <string>

#include "lib/mesh2d.h"

namespace meshpipe {

/// Both at one scale, edges on lines drawn thick. `title` is put above, in plain characters.
std::string chart_svg(const Chart& chart, const PlaneMesh& mesh, const std::string& title);

}  // namespace meshpipe
