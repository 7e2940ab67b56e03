// SPDX-License-Identifier: BSD-3-Clause
// Cuts a surface: splits triangles along the zero level of a field on the vertices.
#pragma once
#include <vector>

#include "lib/core/level_line.h"
#include "lib/core/mesh.h"

namespace meshpipe {

// Both cuts append vertices on existing edges; earlier vertices neither move nor change number. Vertex
// columns are interpolated, face columns copied to the pieces, `model` bits split with their edges; `origin`
// (added as the identity where missing) keeps the triangle of the cleaned input. The remaining quadrilaterals
// are split by the diagonal with the better smallest angle in space.

/// Adds the face column `origin`, each triangle's own number, unless there is one.
void name_origins(Surface& surface);

/// Splits the active triangles (active[t] != 0; empty: all) along the zero level of `field` (one finite value
/// per vertex, linear on triangles); inactive neighbors are split where an edge is. side[t] becomes 0 (field
/// < 0) or 1 for the pieces of active triangles, -1 for others. Where the level crosses an edge within `snap`
/// (a fraction of the edge) of a vertex, it is moved to the vertex. Returns the number of new vertices.
/// Throws: std::logic_error if a column or argument has a wrong length or a value is not finite.
int cut_by_scalar_field(Surface& surface, const std::vector<double>& field, const std::vector<char>& active,
                        std::vector<int>& side, double snap = 0.1);

/// Splits the active triangles along a line as it is: as cut_by_scalar_field, with the line's signs as those
/// of the field. Opposite half-edges follow, unless they are empty.
int cut_along_line(const CutSurface& s, const LevelLine& line, const std::vector<char>& active,
                   std::vector<int>& side);

}  // namespace meshpipe
