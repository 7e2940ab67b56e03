// SPDX-License-Identifier: BSD-3-Clause
// The Laplace maps of a cut as SVG pictures, like the paper's Figs. 3 to 5.
#pragma once
#include <string>
#include <vector>

#include "lib/multiscale.h"

namespace meshpipe {

/// The levels' names: depth and number among those of that depth, "0-0" for the root.
std::vector<std::string> level_names(const std::vector<Level>& levels);

/// One level in its frame: its triangles, darker the more the map shrinks them (the area distortion of Fig.
/// 3), the withdrawn sets with the names of their levels, the holes, the line (red) and the cut that was made
/// of it (black). Sets that lie close together are shown enlarged in the corner, as in Fig. 4.
std::string level_svg(const CutMaps& maps, int level);

/// All levels beside each other, a row a depth, as in Fig. 5. `files[l]` is the picture of level l, relative
/// to this one.
std::string levels_svg(const std::vector<Level>& levels, const std::vector<std::string>& files);

}  // namespace meshpipe
