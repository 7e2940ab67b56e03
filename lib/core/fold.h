// SPDX-License-Identifier: BSD-3-Clause
// Edges at which a mesh folds back where the surface that it stands for does not.
#pragma once
#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns whether unit normals m and n of two neighboring triangles differ by more than 150 degrees.
inline bool turn_back(Vec3 m, Vec3 n) { return dot(m, n) < -0.8660254037844386; }

/// Returns whether they say that these lie flat on each other; their sum then says nothing.
inline bool lie_flat(Vec3 m, Vec3 n) { return dot(m, n) < -0.99; }

/// Returns whether the reference, within an edge length of the middle of edge ab, lacks a triangle with
/// normal about m or one with normal about n (unit vectors). If so, triangles that turn back at the edge are
/// a fold; those of thin plates and sharp ridges are not.
bool faces_one_way(Vec3 a, Vec3 b, Vec3 m, Vec3 n, const Mesh& reference, const Bvh& reference_tree);

}  // namespace meshpipe
