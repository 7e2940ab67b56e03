// SPDX-License-Identifier: BSD-3-Clause
// Steps that all kinds of smoothing have in common.
#pragma once
#include <utility>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Moves vertices back towards `start` around triangles that intersect and did not there: half the way in
/// each of three rounds, then all of it, every round one ring farther out, until none does; at worst the
/// surface is as it was. Flags the vertices moved back in `held`, and returns their number.
int separate(Mesh& mesh, const std::vector<Vec3>& start, std::vector<char>& held);

/// Returns the root mean square of the angles between adjacent triangles (pairs) as oriented, in degrees.
double mean_angle(const Mesh& mesh, const std::vector<std::pair<int, int>>& adjacent);

/// Returns how far vertices may move by default: the mean of these edge lengths, but at most ten times their
/// median, so that one vertex far out does not let all others move across the whole surface.
double default_bound(std::vector<double> lengths);

}  // namespace meshpipe
