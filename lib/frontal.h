// SPDX-License-Identifier: BSD-3-Clause
// The frontal-Delaunay mesher (Rebay 1993) in the metric of a chart, and the sweeps that even its meshes out.
#pragma once
#include "lib/cdt.h"
#include "lib/plane_metric.h"

namespace meshpipe {

/// A triangulation whose vertices know where on the surface they are.
struct SiteMesh {
  Cdt cdt;
  std::vector<Site> site;
  int line_points;  ///< vertices below this number do not move
};

/// Inserts points until every triangle is sized, in rows from the lines inwards. Ends always: a triangle that
/// takes no point is left as it is.
void insert_frontal(SiteMesh& mesh, const SizeMetric& field);

/// Flips to Delaunay and moves inner vertices between their neighbours, `sweeps` times; judged in space.
void smooth_in_plane(SiteMesh& mesh, const SizeMetric& field, int sweeps);

}  // namespace meshpipe
