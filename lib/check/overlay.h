// SPDX-License-Identifier: BSD-3-Clause
// How far a triangle is from a surface: upper bounds by what lies above and below it.
#pragma once
#include <array>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Bounds the distance of a triangle from a surface: follows the surface from its triangle `face` to all
/// triangles above or below `triangle`. If they have its orientation and do not end there, they cover it, and
/// none of its points is farther than the highest of them. Returns that height, or infinity if 48 of them do
/// not prove it to be within `enough`.
double sheet_height(const Connectivity& surface, int face, const std::array<Vec3, 3>& triangle,
                    double enough);

/// Bounds the distance in the same way by all triangles of the surface with the same orientation in the box
/// of the triangle, widened by `enough`: if, projected onto the triangle, they cover it once, returns the
/// height of the highest corner of the overlay; else infinity.
double overlay_height(const Mesh& surface, const Bvh& tree, const std::array<Vec3, 3>& triangle,
                      double enough);

}  // namespace meshpipe
