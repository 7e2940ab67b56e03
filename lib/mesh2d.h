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

/// The lines by the parts 0..n_parts-1 that use them; made once for all. Keeps a reference to them. Linear
/// but for sorting. Precondition: uses name parts and lines that there are.
struct PartLines {
  PartLines(const Lines& given, int n_parts);
  const Lines& lines;
  std::vector<int> start, line;      ///< part p uses line[start[p]..start[p+1]), ascending
  std::vector<std::uint8_t> shared;  ///< per line: several parts use it
  std::vector<int>
      point;  ///< per row of Lines::points: the first end of a line at the same vertex, or the row
};

/// Meshes one chart: constrained Delaunay triangulation of the lines that the part uses (borders, interfaces,
/// embedded model edges), then the mesher's operations until every triangle is sized, and smoothing.
/// `size` is per vertex of the chart's mesh; lengths and sizes are judged in space through the map's metric,
/// averaged at vertices in log space. Exact predicates; location by walking with a hint.
/// Every line segment is an edge of the result and the result covers exactly the region the lines bound.
/// Preconditions: the chart is indexed (index_chart); sizes are positive.
/// Throws, with the part: GoalMissed, with a point, if segments cross or touch, points coincide, the borders
/// are not closed, or bound no region (then nothing is meshed); NotAdmissible if a line point lies on an edge
/// that the chart has not.
PlaneMesh mesh_chart(const Chart& chart, const std::vector<double>& size, const PartLines& lines, int part,
                     Mesher mesher = Mesher::frontal);

}  // namespace meshpipe
