// SPDX-License-Identifier: BSD-3-Clause
// The longest edges that narrow tubes and short closed lines permit.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns per vertex the length of the closed line of border or model edges through it, infinite where there
/// is none: loops that no other such edge meets.
std::vector<double> closed_line_lengths(const Connectivity& surface);

/// Returns per vertex a quarter of the shortest ring through it, where that is below `size` (elsewhere
/// infinity, or more than the size), so that four edges fit around it. A ring is a closed line of border or
/// model edges that meets no other, or the shortest closed path of edges around a tube, or the ring at a
/// size's distance around a peak (sharp_peaks). Tubes are searched where the curvature (per triangle) permits
/// one. A component without borders and model edges has the size of twelve triangles at most.
std::vector<double> local_feature_size(const Connectivity& surface, const std::vector<double>& curvature,
                                       const std::vector<double>& size);

/// Returns the curvature that a surface has to exceed somewhere so that it has a tube too narrow for `size`.
double least_tube_curvature(const std::vector<double>& size);

/// Lowers the sizes along short lines where more than two triangles meet, between the points where such lines
/// meet or end: the triangles around the only segment of such a line can be no better than its length allows.
/// `size` is per vertex.
void lower_along_short_lines(const Mesh& mesh, std::vector<double>& size);

}  // namespace meshpipe
