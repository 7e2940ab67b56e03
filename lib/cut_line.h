// SPDX-License-Identifier: BSD-3-Clause
// The line that cuts a long part in two, drawn through all levels of its Laplace maps (the paper's section 3,
// step 5).
#pragma once
#include <vector>

#include "lib/levels.h"

namespace meshpipe {

/// Draws a line across the root's disk in `direction` (radians), through the centres of all child sets and
/// holes, and recursively through the child sets, and returns for each vertex of the part the signed distance
/// to it, in space and to first order: positive on the left. Never zero.
std::vector<double> cut_line_field(const FilledDisk& disk, const std::vector<Level>& levels,
                                   double direction);

}  // namespace meshpipe
