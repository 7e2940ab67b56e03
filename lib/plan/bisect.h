// SPDX-License-Identifier: BSD-3-Clause
// Cuts of one part of genus 0: by a short line, whatever its shape, or along its limbs.
#pragma once
#include <array>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Cuts `part` (face column `part`) in two along the level line with the least length / sqrt(area of the
/// smaller side) of those with two connected sides without pinched vertices. Lines are levels of the
/// potential between the two vertices of each pair in `apart` (rows of the surface; pairs not in the part are
/// skipped), or of the Fiedler vector if none is left. The side above the level becomes part new_part.
/// Returns false, and changes nothing, if there is no such line.
bool bisect_part(Surface& surface, int part, int new_part, const std::vector<std::array<int, 2>>& apart);

/// Cuts `part` along its limbs, so that none shrinks to nothing in a chart: by multiscale_cut with a limit
/// just below its aspect ratio. Returns the new number of parts; n_parts if there is no such cut, or more
/// than four parts.
int cut_along_limbs(Surface& surface, int part, int n_parts);

}  // namespace meshpipe
