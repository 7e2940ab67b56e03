// SPDX-License-Identifier: BSD-3-Clause
// Motion of an interface towards shorter curves by diffusing the indicator of its two sides.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// The entry of `held` for a vertex whose value is free.
constexpr double not_held = 2;  ///< of a vertex whose value is free

/// Moves an interface by threshold dynamics (Merriman, Bence and Osher): `steps` implicit heat steps (M + t
/// K) s = M sign(s), M lumped, K with clamped cotangents, starting from `sign` on the triangles (+1 or -1);
/// solved by conjugate gradients to a residual of 2e-3 of the whole right-hand side, or 200 of their steps.
/// `time`: t per triangle, a squared length, at least 0. `held`: per vertex the value at which it is held
/// (-1..1), or not_held. Returns s per vertex, whose zero level is the interface; nothing for no steps.
/// Requires: every vertex has a triangle with area.
std::vector<double> threshold_dynamics(const Mesh& mesh, std::vector<double> sign,
                                       const std::vector<double>& time, const std::vector<double>& held,
                                       int steps);

}  // namespace meshpipe
