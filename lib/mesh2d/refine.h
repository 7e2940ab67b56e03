// SPDX-License-Identifier: BSD-3-Clause
// Two meshers that insert points into a constrained Delaunay triangulation in the metric of a chart:
// frontal-Delaunay (Rebay 1993) and Delaunay refinement at circumcenters (Bowyer, Watson 1981).
#pragma once
#include "lib/mesh2d/site_mesh.h"

namespace meshpipe {

/// Inserts points until every triangle has its size, in rows from the lines inwards, so that triangles become
/// nearly equilateral. Always ends: a triangle that takes no point is left as it is.
void refine_frontal(SiteMesh& mesh, const SizeMetric& field);

/// Inserts points in the same way, but in larger triangles only: points may be a little farther apart.
void fill_gaps(SiteMesh& mesh, const SizeMetric& field);

/// Inserts the circumcenter of the largest triangle until every triangle has its size. Always ends.
void refine_delaunay(SiteMesh& mesh, const SizeMetric& field);

}  // namespace meshpipe
