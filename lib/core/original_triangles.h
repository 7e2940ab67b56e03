// SPDX-License-Identifier: BSD-3-Clause
// Recovery of the triangles that a cut surface was made from.
#pragma once
#include <span>
#include <vector>

#include "lib/core/bvh.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Recovers the original triangles of a cut mesh: triangles of equal `origin` (one per triangle, >= 0) that
/// tile one triangle become that triangle; others stay. Points stay, some unused; triangles come by their
/// origin. Linear. `whole_of`, if not null, receives per triangle of `mesh` that of the result around it.
Mesh recover_triangles(const Mesh& mesh, const std::vector<int>& origin,
                       std::vector<int>* whole_of = nullptr);

/// Returns a reference before its triangles were cut, or a copy if it has no column `origin`.
Mesh original_mesh(const Surface& reference);

/// Returns the contacts (lib/core/intersect.h) of a reference: its chords, and where it intersects itself,
/// fans touch, or it lies on itself to the rounding of single-precision coordinates, as it was before it was
/// cut, since new vertices are rounded. If `sheets_meet`, its borders are joined. `near`: unless it is
/// empty, intersections and overlaps are looked for only where they have a point in one of these boxes.
/// Throws: as opposite_halfedges.
Mesh reference_contacts(const Surface& reference, bool sheets_meet, std::span<const Box> near = {});

}  // namespace meshpipe
