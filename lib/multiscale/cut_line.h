// SPDX-License-Identifier: BSD-3-Clause
// The line that cuts a long part in two, drawn through all levels of its Laplace maps (the paper's section 3,
// step 5).
#pragma once
#include <vector>

#include "lib/multiscale/levels.h"

namespace meshpipe {

/// Draws a line across the root's disk in `direction` (radians), through the centers of all child sets and
/// holes, and recursively through the child sets: a polyline for each level, in its own frame. The root's
/// ends lie far outside its disk; a child's start and end where the parent's line meets the set's border.
std::vector<std::vector<Vec2>> cut_lines(const FilledDisk& disk, const std::vector<Level>& levels,
                                         double direction);

/// The signed distance of each vertex of the part to the line, in space and to first order: positive on the
/// left. Never zero. `lines` as above.
std::vector<double> cut_line_field(const FilledDisk& disk, const std::vector<Level>& levels,
                                   const std::vector<std::vector<Vec2>>& lines);

}  // namespace meshpipe
