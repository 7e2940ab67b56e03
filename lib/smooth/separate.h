// SPDX-License-Identifier: BSD-3-Clause
// Steps that all kinds of smoothing have in common.
#pragma once
#include <utility>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Moves vertices back to `start` where triangles intersect that did not do so there: half the way, then, in
/// growing neighborhoods, all of it, which ends with the surface as it was. Vertices moved back are held from
/// then on. Returns their number.
int separate(Mesh& mesh, const std::vector<Vec3>& start, std::vector<char>& held);

/// Root mean square of the angles between triangles, each oriented as it is, in degrees.
double mean_angle(const Mesh& mesh, const std::vector<std::pair<int, int>>& adjacent);

}  // namespace meshpipe
