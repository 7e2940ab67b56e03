// SPDX-License-Identifier: BSD-3-Clause
// Triangles that a convex border would flatten.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

/// Splits the ears of every part (face column `part`, 0..n_parts-1): a triangle with two edges on its part's
/// longest loop has all its corners on the loop, and a circle flattens it. It is cut from its tip to the
/// middle of its third edge, and its neighbour there is split with it. Returns how many; columns follow as in
/// lib/cut.h. Parts that are a single triangle are left alone.
int split_ears(Surface& surface, int n_parts);

}  // namespace meshpipe
