// SPDX-License-Identifier: BSD-3-Clause
// The Laplace maps of a cut as SVG pictures, like Figs. 3 to 5 of the paper.
#pragma once
#include <string>
#include <vector>

#include "lib/multiscale/multiscale.h"

namespace meshpipe {

/// Returns names of levels: depth and number within the depth, "0-0" for the root.
std::vector<std::string> level_names(const std::vector<Level>& levels);

/// Returns a picture of one level: triangles, the darker the more the map shrinks them (Fig. 3); the
/// withdrawn sets with the names of their levels; holes; the polyline (red) and the cut made of it (black).
/// Sets that lie close together are enlarged in the corner (Fig. 4).
std::string level_svg(const CutMaps& maps, int level);

/// Returns a picture of all levels, one row per depth (Fig. 5). `files[l]` is the picture of level l,
/// relative to this one.
std::string levels_svg(const std::vector<Level>& levels, const std::vector<std::string>& files);

}  // namespace meshpipe
