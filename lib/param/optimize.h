// SPDX-License-Identifier: BSD-3-Clause
// Lowering the distortion of a one-to-one map, which stays one.
#pragma once
#include "lib/param/disk.h"

namespace meshpipe {

/// Lowers the symmetric Dirichlet energy of a map, the sum over triangles of area (|J|^2 + |J^-1|^2), least
/// where J is a rotation, with a free border, in at most `steps` steps; stops when a step gains less than a
/// thousandth. The result has the part's area. Returns the number of steps taken. Requires: every triangle of
/// uv is positively oriented and the border is simple; both stay so, by exact signs, since a step is halved
/// until they do.
/// Source: scalable locally injective mappings (Rabinovich and others 2017), progressive parameterizations
/// (Liu and others 2018).
int lower_distortion(const SubMesh& part, const Disk& disk, int steps, std::vector<Vec2>& uv);

}  // namespace meshpipe
