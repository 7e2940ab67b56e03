// SPDX-License-Identifier: BSD-3-Clause
// Triangles of no height whose third corner is next to the middle of their longest edge.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Flips the longest edge of triangles so low that rounding of single-precision coordinates decides which way
/// they face (3e-6 of the diagonal), where the two triangles that this makes are higher and face the way of
/// the neighbor across that edge, whose face columns both get. No edge between patches, and none with a
/// number in `line` (per half-edge, -1: none) is flipped. Returns the number of flips. Throws: as
/// opposite_halfedges.
int flip_caps(Surface& surface, const std::vector<int>& line);

}  // namespace meshpipe
