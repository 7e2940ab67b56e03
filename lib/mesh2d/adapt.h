// SPDX-License-Identifier: BSD-3-Clause
// MeshAdapt: refines a mesh by local operations on its edges.
#pragma once
#include "lib/mesh2d/site_mesh.h"

namespace meshpipe {

/// Splits long edges, collapses short ones, flips, and smooths, in a bounded number of rounds, until edges
/// have the length that the size asks for, measured on the surface. Fixed edges and their ends stay; numbers
/// of other vertices change.
void adapt_edges(SiteMesh& mesh, const SizeMetric& field);

}  // namespace meshpipe
