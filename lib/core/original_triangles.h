// SPDX-License-Identifier: BSD-3-Clause
// Recovery of the triangles that a cut surface was made from.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Recovers the original triangles of a cut mesh: pieces of equal `origin` that tile one triangle become that
/// triangle; others stay, as those of negative `origin`. Points stay, some unused. Linear time.
/// Requires: origin.size() == mesh.tris.size().
/// `whole_of`, if not null, receives for each triangle of `mesh` the triangle of the result that contains it.
Mesh recover_triangles(const Mesh& mesh, const std::vector<int>& origin,
                       std::vector<int>* whole_of = nullptr);

}  // namespace meshpipe
