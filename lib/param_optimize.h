// SPDX-License-Identifier: BSD-3-Clause
// Lowering the distortion of a one-to-one map, which stays one.
#pragma once
#include "lib/param_disk.h"

namespace meshpipe {

/// At most `steps` steps of scalable locally injective mappings (Rabinovich and others 2017) on the symmetric
/// Dirichlet energy, sum over the triangles of area (|J|^2 + |J^-1|^2), least where J is a rotation; the
/// border is free. Triangles that are distorted by more than a factor of 8 are first brought to that (Liu and
/// others 2018). Ends earlier once a step gains less than a thousandth.
///
/// Precondition: every triangle of uv is positively oriented and the border is simple. Both hold after every
/// step, by exact signs: a step is halved until they do. Triangles flatter in space than 1 : 100 count as
/// that flat. The result has the part's area. Returns the number of steps taken.
int lower_distortion(const SubMesh& part, const Disk& disk, int steps, std::vector<Vec2>& uv,
                     SolveTime* time);

}  // namespace meshpipe
