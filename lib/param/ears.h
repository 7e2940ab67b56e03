// SPDX-License-Identifier: BSD-3-Clause
// Triangles that a convex border would flatten.
#pragma once
#include "lib/core/mesh.h"

namespace meshpipe {

/// Splits the triangles with two edges on the longest loop of their part (face column `part`, 0..n_parts-1),
/// which a convex border would flatten: from the corner between these edges to the middle of the third, with
/// the neighbor there. Columns follow as in lib/core/cut.h. Parts of a single triangle stay. Returns the
/// number split.
int split_ears(Surface& surface, int n_parts);

}  // namespace meshpipe
