// SPDX-License-Identifier: BSD-3-Clause
// Cutting a part of genus 0 in two by a short line, whatever its shape.
#pragma once
#include <array>
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// Cuts the triangles of `part` (face column `part`) in two. For each pair of vertices in `apart` (the part's
/// own numbers, as split_by_label gives them) the lines tried are the levels of the potential between a
/// source at one and a sink at the other; without pairs, those of the Fiedler vector (the slowest vibration
/// of the free part), which cross its long direction. The line taken is the shortest over the root of the
/// smaller side's area that leaves two connected halves without pinched vertices; both kinds of field have
/// connected sides but for rounding. The triangles above the level get the label `new_part`; neighbours are
/// split conformingly. Returns false, and changes nothing, if no line will do.
bool bisect_part(Surface& surface, int part, int new_part, const std::vector<std::array<int, 2>>& apart);

}  // namespace meshpipe
