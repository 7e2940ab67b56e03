// SPDX-License-Identifier: BSD-3-Clause
// A loop in space filled by triangles of least area.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns the triangles of least total area that fill a loop of n corners, as numbers of corners, oriented
/// along the loop; in time n^3. Between equal areas, short edges decide. `joined[i * n + j]`, i < j: no
/// triangle may have an edge between these corners. Returns none if that forbids all.
/// Source: Barequet and Sharir, Filling gaps in the boundary of a polyhedron, 1995.
std::vector<Tri> least_area_triangles(const std::vector<Vec3>& corners, const std::vector<char>& joined);

}  // namespace meshpipe
