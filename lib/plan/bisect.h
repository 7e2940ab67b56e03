// SPDX-License-Identifier: BSD-3-Clause
// Cuts of one part of genus 0: by a short line, whatever its shape, or along its limbs.
#pragma once
#include <array>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Cuts `part` (face column `part`) in two along the line of least length / sqrt(area of the smaller side) of
/// those with two connected sides without pinched vertices. Lines are levels of the potential between both
/// vertices of each pair in `apart` (numbers in the surface; pairs not in the part are skipped), or of the
/// Fiedler vector if none is left. The side above the level becomes part new_part. Returns false, and changes
/// nothing, if there is no such line.
bool bisect_part(Surface& surface, int part, int new_part, const std::vector<std::array<int, 2>>& apart);

/// Cuts `part` by multiscale_cut although its aspect ratio is admissible: along its limbs, so that none
/// shrinks to nothing in a chart. Returns the new number of parts; n_parts, with nothing changed, if
/// there is no such cut.
int cut_along_limbs(Surface& surface, int part, int n_parts);

}  // namespace meshpipe
