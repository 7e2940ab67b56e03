// SPDX-License-Identifier: BSD-3-Clause
// Normals of triangles and vertices.
#pragma once
#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns the unit normal of each triangle; zero where a triangle has no area.
std::vector<Vec3> face_normals(const Mesh& mesh);

/// Returns per vertex the sum of area_vector of its triangles: a normal, not of unit length.
std::vector<Vec3> vertex_area_vectors(const Mesh& mesh);

/// Returns the unit normal of each vertex, its triangles weighted by area; zero where the sum vanishes.
std::vector<Vec3> vertex_normals(const Mesh& mesh);

/// Returns for each vertex a third of the area of its triangles.
std::vector<double> vertex_areas(const Mesh& mesh);

}  // namespace meshpipe
