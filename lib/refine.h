// SPDX-License-Identifier: BSD-3-Clause
// Two meshers that insert points into a constrained Delaunay triangulation in the metric of a chart:
// frontal-Delaunay (Rebay 1993) and Delaunay refinement at circumcentres (Bowyer, Watson 1981).
#pragma once
#include "lib/site_mesh.h"

namespace meshpipe {

/// Inserts points until every triangle is sized: in rows from the lines inwards, so that triangles come out
/// nearly equilateral. Ends always: a triangle that takes no point is left as it is.
void refine_frontal(SiteMesh& mesh, const SizeMetric& field);

/// Inserts the circumcentre of the largest triangle until every one is sized. Ends always, the same way.
void refine_delaunay(SiteMesh& mesh, const SizeMetric& field);

}  // namespace meshpipe
