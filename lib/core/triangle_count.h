// SPDX-License-Identifier: BSD-3-Clause
// Edge length and number of equilateral triangles, each from the other.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns the edge length at which n equilateral triangles have this area.
double size_for_count(double area, double n);

/// Of its longest edge: the largest size that distances of a triangle are judged by, the most in a mesh that
/// obeys its field. Where a surface admits only smaller triangles than were asked for, it is less than that.
constexpr double size_over_longest = 1.5;

/// Returns the number of equilateral triangles that a size field asks for: the integral of dA / (sqrt(3)/4
/// h^2), h the mean of a triangle's corners. Requires: size[v] > 0.
double count_for_size(const Mesh& mesh, const std::vector<double>& size);

}  // namespace meshpipe
