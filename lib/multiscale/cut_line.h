// SPDX-License-Identifier: BSD-3-Clause
// The line that cuts a long part in two, drawn through all levels of its Laplace maps (the paper's section 3,
// step 5).
#pragma once
#include <vector>

#include "lib/multiscale/levels.h"

namespace meshpipe {

/// Returns a line across the root's disk in `direction` (radians), through the centers of all child sets and
/// holes, and recursively through the child sets: a polyline per level, in the level's own frame. The root's
/// ends lie far outside its disk; a child's start and end where the parent's line meets the set's border.
std::vector<std::vector<Vec2>> cut_lines(const FilledDisk& disk, const std::vector<Level>& levels,
                                         double direction);

/// Returns per vertex of the part its signed distance from the line, a length to first order: positive on the
/// left, never zero. `lines`: as from cut_lines.
std::vector<double> cut_line_field(const FilledDisk& disk, const std::vector<Level>& levels,
                                   const std::vector<std::vector<Vec2>>& lines);

}  // namespace meshpipe
