// SPDX-License-Identifier: BSD-3-Clause
// Steps that all kinds of smoothing have in common.
#pragma once
#include <utility>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Moves vertices back towards `start` where triangles newly intersect: three times half the way, then, in
/// growing neighborhoods, all of it, which ends with the surface as it was. Flags the vertices moved back in
/// `held`, and returns their number.
int separate(Mesh& mesh, const std::vector<Vec3>& start, std::vector<char>& held);

/// Returns the root mean square of the angles between adjacent triangles (pairs) as oriented, in degrees.
double mean_angle(const Mesh& mesh, const std::vector<std::pair<int, int>>& adjacent);

}  // namespace meshpipe
