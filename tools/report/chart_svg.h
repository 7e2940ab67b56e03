// SPDX-License-Identifier: BSD-3-Clause
// A chart as an SVG picture: the mapped triangles of the surface, and the mesh made there.
#pragma once
#include <string>

#include "lib/mesh2d/mesh2d.h"

namespace meshpipe {

/// Returns both side by side at one scale; edges on lines are drawn thick. `title` stands above.
std::string chart_svg(const Chart& chart, const PlaneMesh& mesh, const std::string& title);

}  // namespace meshpipe
