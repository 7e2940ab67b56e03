// SPDX-License-Identifier: BSD-3-Clause
// The longest edges that narrow tubes and short closed lines permit.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Edges around a tube or along a closed line: fewer cannot keep its topology.
constexpr double ring_edges = 4;

/// Returns per vertex the length of the loop of border or model edges through it that no other such edge
/// meets; infinity where there is none.
std::vector<double> closed_line_lengths(const Connectivity& surface);

/// Returns per vertex a quarter of the length of the shortest ring through it, so that four edges fit around
/// it, where that is below `size` (per vertex); elsewhere infinity, or more than the size. A ring is a loop
/// of closed_line_lengths, the shortest closed path of edges around a tube, or the ring at a size's distance
/// around a peak (sharp_peaks). Tubes are searched where `curvature` (per triangle, 1 / length) permits one.
/// A component without borders and model edges gets at most the size of twelve triangles.
std::vector<double> local_feature_size(const Connectivity& surface, const std::vector<double>& curvature,
                                       const std::vector<double>& size);

/// Returns the least size near peaks; without it, each run on what another has set would lower it again.
double least_at_peaks(const Mesh& mesh, const std::vector<double>& size);

/// Returns the curvature (1 / length) that a surface with a tube too narrow for `size` exceeds somewhere.
double least_tube_curvature(const std::vector<double>& size);

/// Lowers the sizes (per vertex) along short lines where more than two triangles meet, between the points
/// where such lines meet or end: triangles at the only segment of such a line can be no better than its
/// length allows.
void lower_along_short_lines(const Mesh& mesh, std::vector<double>& size);

}  // namespace meshpipe
