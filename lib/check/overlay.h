// SPDX-License-Identifier: BSD-3-Clause
// How far a triangle is from a surface: upper bounds by what lies above and below it.
#pragma once
#include <array>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Follows the surface from its triangle `face` to all that are above or below `triangle`: if they have its
/// orientation and do not end there, they cover it, and none of its points is farther than the highest of
/// them. Returns that height, or infinity if it is not proved (by at most 48) to be within `enough`.
double sheet_height(const Connectivity& surface, int face, const std::array<Vec3, 3>& triangle,
                    double enough);

/// Projects the part of the surface with the same orientation onto a triangle: if it covers the triangle
/// once, no point of the triangle is farther than the highest corner of the overlay. Returns that height, or
/// infinity.
double overlay_height(const Mesh& surface, const Bvh& tree, const std::array<Vec3, 3>& triangle,
                      double enough);

}  // namespace meshpipe
