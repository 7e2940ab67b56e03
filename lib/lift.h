// SPDX-License-Identifier: BSD-3-Clause
// From plane meshes to one mesh on the surface: lift by barycentric coordinates, glue along the lines.
#pragma once
#include "lib/lines.h"
#include "lib/mesh2d.h"

namespace meshpipe {

/// A mesh each of whose vertices knows its place on a reference surface.
struct LiftedMesh : Mesh {
  std::vector<Place> place;         ///< triangle of the reference and barycentrics
  std::vector<int> kind;            ///< 0 inside, 1 on a line, 2 corner (end of lines)
  std::vector<int> line;            ///< line it lies on, or -1
  std::vector<double> size;         ///< size field, interpolated
  std::vector<int> patch;           ///< per triangle, by place on the reference
  std::vector<int> part;            ///< per triangle
  std::vector<std::uint8_t> model;  ///< per triangle: bit i: edge from corner i to i+1 is a model edge
};

/// Glues the plane meshes of all charts: a line point becomes one vertex whatever the number of charts that
/// use it (line points first, by row; then inside points by part). Positions are exact on edges and linear in
/// triangles. Patch labels are given region by region (triangles joined across edges that are not model edges
/// or borders), by the area-weighted majority of the reference patches below. Indexes the charts where it has
/// to look for a place.
/// Preconditions: vertex column `size` on the reference, a chart and a plane mesh a part, in the same order,
/// meshes of these charts and lines (line_point a row of lines.points, place a triangle of the chart).
/// Throws BadInput if a line point is on an edge that the reference has not; GoalMissed, with the vertex or
/// the edge, if what was glued is no manifold, is pinched, or its border is not the border lines' segments.
LiftedMesh lift(const Surface& reference, std::vector<Chart> charts, const Lines& lines,
                const std::vector<PlaneMesh>& meshes);

}  // namespace meshpipe
