// SPDX-License-Identifier: BSD-3-Clause
// A mesh from elsewhere, placed on a reference surface.
#pragma once
#include "lib/lift.h"

namespace meshpipe {

/// Places every vertex of a mesh at the nearest point of the reference: vertices of the mesh's border on the
/// reference's border and vertices of its model edges (face column `model`) on the reference's model edges,
/// where the reference has any. Points move there. Sizes are those of the reference's column `size`, else the
/// edge length at which the reference has as many triangles as the mesh. Precondition: both have triangles;
/// the mesh is an oriented manifold (else BadInput by opposite_halfedges). Throws NotAdmissible if more than
/// half of the vertices are farther away than a mean edge.
LiftedMesh place_on(const Surface& mesh, const Surface& reference);

}  // namespace meshpipe
