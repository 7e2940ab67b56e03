// SPDX-License-Identifier: BSD-3-Clause
// The one primitive that cuts surfaces: split triangles along the zero level of a field on the vertices.
#pragma once
#include <vector>

#include "lib/level_line.h"
#include "lib/mesh.h"

namespace meshpipe {

/// Splits the triangles of `surface` crossed by the zero level of `field` (a value per vertex, linear on
/// triangles) and sets side[t] to 0 (field < 0) or 1 (field >= 0) for every triangle of the result.
///
/// Only triangles with active[t] != 0 are cut (an empty `active` means all); an edge is cut if either of its
/// triangles is active, so neighbours that are not active are split conformingly and get side -1.
/// A crossing within `snap` of an edge's end is moved to the vertex (no slivers), as are levels that touch
/// one. New vertices lie on existing edges and are appended; earlier vertices neither move nor change number.
/// Every vertex column is interpolated, every face column copied to the pieces; `model` bits are split with
/// their edges; `origin` (added as the identity when missing) keeps the triangle of the cleaned input.
/// The diagonal of the remaining quadrilateral is the one with the better smallest angle in space.
/// Returns the number of vertices added. Throws std::logic_error on columns of the wrong length.
int cut_by_scalar_field(Surface& surface, const std::vector<double>& field, const std::vector<char>& active,
                        std::vector<int>& side, double snap = 0.1);

/// The same along a line as it is: what field < 0 and field >= 0 are there, the signs are here. `opposite`,
/// if given, is the surface's (lib/topology.h), before and after.
int cut_along_line(Surface& surface, const LevelLine& line, const std::vector<char>& active,
                   std::vector<int>& side, std::vector<int>* opposite = nullptr);

}  // namespace meshpipe
