// SPDX-License-Identifier: BSD-3-Clause
// A loop in space filled by triangles of least area.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns the triangulation of a loop of n corners of least area, as places in the loop; cubic in n.
/// `joined[i * n + j]`: no triangle may have an edge between these corners. Returns none if that forbids all.
/// Source: Barequet and Sharir, Filling gaps in the boundary of a polyhedron, 1995.
std::vector<Tri> least_area_triangles(const std::vector<Vec3>& corners, const std::vector<char>& joined);

}  // namespace meshpipe
