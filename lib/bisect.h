// SPDX-License-Identifier: BSD-3-Clause
// Cutting a part of genus 0 in two: by a short line, whatever its shape, along its limbs,
// or at model edges.
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
/// split conformingly. `even` counts vertices instead of areas, gives all triangles the same weight, and
/// takes no line with less than a third on one side: for parts of which their shape only ever lets a few
/// triangles be cut off. Returns false, and changes nothing, if no line will do.
bool bisect_part(Surface& surface, int part, int new_part, const std::vector<std::array<int, 2>>& apart,
                 bool even = false);

/// Cuts `part` along the model edges (face column `model`) inside it, which the mesh keeps in any case:
/// pieces that have no map to the plane are joined to a neighbour. Pieces above the first get the labels
/// n_parts, n_parts + 1, ... Returns the new number of parts; n_parts, with nothing changed, if the edges
/// enclose nothing, or little more than single triangles.
int cut_along_model_edges(Surface& surface, int part, int n_parts);

/// Cuts `part` by the multiscale partitioner (lib/multiscale.h) although its aspect ratio is admissible:
/// along its limbs, so that none shrinks to nothing in a chart. Parts above the first get the labels n_parts,
/// n_parts + 1, ... Returns the new number of parts; n_parts, with nothing changed, if the partitioner cannot
/// cut it.
int cut_along_limbs(Surface& surface, int part, int n_parts);

}  // namespace meshpipe
