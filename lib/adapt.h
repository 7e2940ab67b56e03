// SPDX-License-Identifier: BSD-3-Clause
// MeshAdapt: a mesh is brought to its size by local operations on its edges.
#pragma once
#include "lib/site_mesh.h"

namespace meshpipe {

/// Splits long edges, collapses short ones, swaps, and moves vertices between their neighbours, in rounds,
/// until edges have the length that the size asks for, measured on the surface. Fixed edges and their ends
/// stay. Ends always. Vertices that collapses leave without triangles are taken out, so numbers from
/// mesh.line_points on may change.
void adapt_edges(SiteMesh& mesh, const SizeMetric& field);

}  // namespace meshpipe
