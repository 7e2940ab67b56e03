// SPDX-License-Identifier: BSD-3-Clause
// Makes any triangle soup an oriented manifold, and tells every repair.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

struct CleanReport {
  int input_vertices = 0, input_triangles = 0;
  int welded = 0;             ///< vertices merged with an equal one
  int unreferenced = 0;       ///< vertices no triangle uses
  int degenerate = 0;         ///< triangles with a repeated vertex, or of zero area: dropped or flipped away
  int duplicate = 0;          ///< triangles with the same three vertices as an earlier one
  int flipped = 0;            ///< triangles turned round
  int nonmanifold_edges = 0;  ///< edges of more than two triangles, split into sheets
  int pinched = 0;            ///< vertices split into one copy a fan, but for those on split edges
  int flat = 0;               ///< triangles of zero area left in, where dropping them would open a crack
  bool nothing() const {
    return !(welded || unreferenced || degenerate || duplicate || flipped || nonmanifold_edges || pinched);
  }
};

/// Welds vertices of equal coordinates, drops degenerate and duplicate triangles, orients every component (by
/// majority; a closed one outward), splits non-manifold edges and pinched vertices. Face columns follow their
/// triangles; vertex columns those of the first vertex welded. Vertices are renumbered by first use if some
/// had to go; copies come last otherwise. A surface that needs none of it is left bit for bit as it is; one
/// that does loses the face column `model`. Throws NotAdmissible naming a triangle if a component is not
/// orientable, or if no triangle is left.
CleanReport clean(Surface& surface);

}  // namespace meshpipe
