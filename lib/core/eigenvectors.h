// SPDX-License-Identifier: BSD-3-Clause
// Principal axes.
#pragma once
#include <array>

#include "lib/core/vec.h"

namespace meshpipe {

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Computes the unit eigenvectors of a symmetric matrix, in no particular order, by Jacobi rotations.
std::array<Vec3, 3> eigenvectors(Matrix3 m);

}  // namespace meshpipe
