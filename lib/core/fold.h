// SPDX-License-Identifier: BSD-3-Clause
// Edges at which a mesh folds back where the surface that it stands for does not.
#pragma once
#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Do triangles with unit normals m and n turn by more than 150 degrees at the edge between them?
inline bool turn_back(Vec3 m, Vec3 n) { return dot(m, n) < -0.8660254037844386; }

/// Has the reference within an edge length of the edge a-b only one of the orientations m and n? Triangles
/// that turn back there are a fold; those of thin plates and sharp ridges are none.
bool faces_one_way(Vec3 a, Vec3 b, Vec3 m, Vec3 n, const Mesh& reference, const Bvh& reference_tree);

}  // namespace meshpipe
