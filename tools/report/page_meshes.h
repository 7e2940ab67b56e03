// SPDX-License-Identifier: BSD-3-Clause
// The meshes that mreport's page shows next to the result, and the edges that it draws thick.
#pragma once
#include "formats/stream.h"
#include "lib/core/chart.h"

namespace meshpipe {

/// Returns a reference as it was before cuts divided its triangles, with face columns `patch` and `model`
/// where it has them.
Surface before_cuts(const Surface& reference);

/// Returns the edges on which mlines has put lines, as bits like those of face column `model`: model edges,
/// borders, and edges between parts.
std::vector<std::uint8_t> line_edges(const Surface& surface);

/// Returns the points that divide the lines of a stream.
std::vector<Vec3> line_points(const Stream& stream);

/// Returns for each triangle how far apart thick edges are around it: twice the area over the length of thick
/// edges (bits) of the region that they bound; infinite where there are none.
std::vector<double> spacing_of(const Mesh& mesh, const std::vector<std::uint8_t>& thick);

/// Lays the charts of a surface in rows, the highest first, each as large as its part. Triangles keep their
/// numbers; those of no chart have no area.
Mesh flat_charts(const Surface& surface, const std::vector<Chart>& charts);

/// The meshes that mmesh2d has made.
struct PlaneMeshes {
  Surface space;  ///< on the surface, with face columns `part` and `model`, the bits of edges on lines
  std::vector<Vec3> flat;  ///< its points in the layout of flat_charts
};
PlaneMeshes plane_meshes(const Stream& stream, const std::vector<Chart>& charts);

}  // namespace meshpipe
