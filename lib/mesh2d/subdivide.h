// SPDX-License-Identifier: BSD-3-Clause
// Regular meshes by subdivision of a mesh of twice the size.
#pragma once
#include "lib/mesh2d/site_mesh.h"

namespace meshpipe {

/// Meshes the region with twice the size, with every other line point, removes pairs of dislocations there,
/// and inserts the vertices of that mesh and the middles of its edges. Middles have six neighbors, so that
/// few vertices become irregular. What is too near to lines or other vertices is left out.
///   segments: all that `mesh` has, line by line
///   stay: the number of points on borders and model edges, which what is next to them has to fit
/// Returns: false, with nothing inserted, if the vertices of the mesh of twice the size are fewer than those,
/// or its lines would cross.
bool insert_subdivided(SiteMesh& mesh, const SizeMetric& field, const std::vector<FixedEdge>& segments,
                       int stay);

}  // namespace meshpipe
