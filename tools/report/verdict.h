// SPDX-License-Identifier: BSD-3-Clause
// A verdict as text and as a picture.
#pragma once
#include <string>
#include <vector>

#include "formats/stream.h"
#include "lib/check/check.h"

namespace meshpipe {

/// Returns the lines of a table of reference and result. Counts that are 0 in both are left out, except
/// genus, loops and self-intersections.
std::vector<std::string> figure_table(const std::vector<Figure>& figures);

/// Histograms of both meshes as SVG: kappa, its smallest values, and the smallest angle.
std::string findings_svg(const Findings& findings);

}  // namespace meshpipe
