// SPDX-License-Identifier: BSD-3-Clause
// MeshAdapt: refines a mesh by local operations on its edges.
#pragma once
#include "lib/mesh2d/site_mesh.h"

namespace meshpipe {

/// Splits long edges, collapses short ones, flips and smooths, in a bounded number of rounds, until edges
/// have the length that `field` asks for, measured in space. Fixed edges stay; other vertices are renumbered.
void adapt_edges(SiteMesh& mesh, const SizeMetric& field);

}  // namespace meshpipe
