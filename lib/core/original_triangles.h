// SPDX-License-Identifier: BSD-3-Clause
// Recovery of the triangles that a cut surface was made from.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Recovers the original triangles of a cut mesh: triangles of equal `origin` (one per triangle, >= 0) that
/// tile one triangle become that triangle; others stay. Points stay, some unused; triangles come by their
/// origin. Linear. `whole_of`, if not null, receives per triangle of `mesh` that of the result around it.
Mesh recover_triangles(const Mesh& mesh, const std::vector<int>& origin,
                       std::vector<int>* whole_of = nullptr);

/// Returns a reference before its triangles were cut, or a copy if it has no column `origin`. Look for its
/// intersections there: new vertices are rounded, so sheets may cross in the cut one only.
Mesh original_mesh(const Surface& reference);

}  // namespace meshpipe
