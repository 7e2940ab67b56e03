// SPDX-License-Identifier: BSD-3-Clause
// Edge length and number of equilateral triangles, each from the other.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns the edge length at which n equilateral triangles have this area in total.
double size_for_count(double area, double n);

/// The largest size by which distances of a triangle are judged, over its longest edge: the most in a mesh
/// that obeys its size field. Where a surface admits only smaller triangles than were asked for, the size is
/// less than that.
constexpr double size_over_longest = 1.5;

/// Returns the number of equilateral triangles that a size field (per vertex, > 0, linear on triangles) asks
/// for: the integral of dA / (sqrt(3)/4 h^2), with the mean of the corners for h where they differ by less
/// than a factor of 2.
double count_for_size(const Mesh& mesh, const std::vector<double>& size);
/// Returns the same, but per part no fewer than a triangulation needs whose only vertices are on the part's
/// border and on model edges in it. `part`: per triangle, from 0, below the number of triangles.
double count_with_borders(const Connectivity& surface, const std::vector<int>& part,
                          const std::vector<double>& size);

}  // namespace meshpipe
