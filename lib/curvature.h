// SPDX-License-Identifier: BSD-3-Clause
// How much a triangulated surface bends, robust to noise and slivers.
#pragma once
#include <cstdint>
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// The largest absolute principal curvature (one over a length) at every triangle. The curvature measure of
/// the edges (signed angle between the normals times length, along the edge: Cohen-Steiner and Morvan,
/// "Restricted Delaunay triangulations and normal cycle", 2003) and the area are spread over about the same
/// few rings of triangles before one is divided by the other: the measure of an area does not depend on how
/// it is triangulated, and noise cancels in it. Neither crosses an edge marked in `model` (bit i of triangle
/// t: the edge from corner i to i+1; empty: none), whose own angle is left out. `opposite` as in lib/mesh.h.
/// Triangles without area have that of their neighbourhood, 0 if that has none.
std::vector<double> face_curvature(const Mesh& mesh, const std::vector<int>& opposite,
                                   const std::vector<std::uint8_t>& model);

}  // namespace meshpipe
