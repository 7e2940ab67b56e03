// SPDX-License-Identifier: BSD-3-Clause
// Meshing of a chart in the plane under the metric of its map (the paper's step 5).
#pragma once
#include "lib/chart.h"
#include "lib/lines.h"

namespace meshpipe {

/// A point of a plane mesh. line_point: row of Lines::points it stands for (rows that are the same surface
/// vertex count as one; the smallest row is used), or -1 inside. place: where in the chart it lies (chart
/// triangle numbers).
struct ChartPoint {
  Vec2 uv;
  int line_point = -1;
  Place place;
};

struct PlaneMesh {
  std::vector<ChartPoint> points;     ///< line points first
  std::vector<Tri> tris;              ///< positively oriented in the plane
  std::vector<int> opposite;          ///< half-edges, -1 on the border
  std::vector<std::uint8_t> on_line;  ///< per half-edge: it is a segment of a line
};

/// frontal: frontal-Delaunay (Rebay 1993). delaunay: refinement at circumcentres. meshadapt: edges split,
/// collapsed and swapped.
enum class Mesher { frontal, delaunay, meshadapt };

/// Meshes one chart: constrained Delaunay triangulation of the lines that the part uses (borders, interfaces,
/// embedded model edges), then the mesher's operations until every triangle is sized, and smoothing.
/// `size` is per vertex of the chart's mesh; lengths and sizes are judged in space through the map's metric,
/// averaged at vertices in log space. Exact predicates; location by walking with a hint.
/// Every line segment is an edge of the result and the result covers exactly the region the lines bound.
/// Throws GoalMissed with part and point if the segments cross (then nothing is meshed).
PlaneMesh mesh_chart(const Chart& chart, const std::vector<double>& size, const Lines& lines, int part,
                     Mesher mesher = Mesher::frontal);

}  // namespace meshpipe
