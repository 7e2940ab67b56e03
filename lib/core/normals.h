// SPDX-License-Identifier: BSD-3-Clause
// Normals of triangles and vertices.
#pragma once
#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns the unit normal of each triangle; zero where a triangle has no area.
std::vector<Vec3> face_normals(const Mesh& mesh);

/// Returns, per vertex, the sum of its triangles' area vectors: the normal weighted by area, not of length 1.
std::vector<Vec3> vertex_area_vectors(const Mesh& mesh);

/// Returns the unit normals of the vertices, weighted by area; zero where the weighted sum vanishes.
std::vector<Vec3> vertex_normals(const Mesh& mesh);

/// Returns a third of the area of each vertex's triangles.
std::vector<double> vertex_areas(const Mesh& mesh);

}  // namespace meshpipe
