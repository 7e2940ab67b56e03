// SPDX-License-Identifier: BSD-3-Clause
// Slivers of an arrangement removed, as rounding makes them intersect again.
#pragma once
#include <vector>

#include "lib/resolve/arrange.h"

namespace meshpipe {

/// Points and the pieces between them.
struct PieceMesh {
  std::vector<Vec3> points;
  Pieces pieces;
};

/// Merges vertices with the same coordinates, drops triangles without area and unused vertices, and unites
/// triangles with the same vertices. Clears `piece_of`.
void normalize(PieceMesh& mesh);

/// Merges vertices no farther apart than `tolerance`, and splits edges at vertices of their triangle no
/// farther from them, in the triangles at the flagged vertices. What was closed stays closed. The result is
/// normalized.
void remove_slivers(PieceMesh& mesh, const std::vector<char>& flagged, double tolerance);

}  // namespace meshpipe
