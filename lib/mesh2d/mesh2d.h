// SPDX-License-Identifier: BSD-3-Clause
// Meshing of a chart in the plane under the metric of its map (the paper's step 5).
#pragma once
#include "lib/core/chart.h"
#include "lib/core/lists.h"
#include "lib/lines/lines.h"

namespace meshpipe {

/// A point of a plane mesh.
struct ChartPoint {
  Vec2 uv;
  int line_point = -1;  ///< row of Lines::points, -1 inside; of rows at one surface vertex, the smallest
  Place place;          ///< in the chart's own triangle numbers
};

struct PlaneMesh {
  std::vector<ChartPoint> points;     ///< line points first
  std::vector<Tri> tris;              ///< positively oriented in the plane
  std::vector<int> opposite;          ///< half-edges, -1 on the border
  std::vector<std::uint8_t> on_line;  ///< per half-edge: it is a segment of a line
};

/// How the plane is filled. frontal: frontal-Delaunay (Rebay 1993), from a mesh of twice the size where it
/// can. delaunay: refinement at circumcenters. meshadapt: edges split, collapsed and flipped.
enum class Mesher { frontal, delaunay, meshadapt };

/// The lines by the parts 0..n_parts-1 that use them, for mesh_chart. Keeps a reference to the lines.
/// Requires: every use names a part and a line that exist.
struct PartLines {
  PartLines(const Lines& given, int n_parts);
  const Lines& lines;
  Lists lines_of_part;               ///< ascending
  std::vector<std::uint8_t> shared;  ///< per line: several parts use it
  std::vector<int> point;  ///< per row of Lines::points: the first line end at its vertex, or the row itself
};

/// Meshes chart `part`: triangulates the region that its lines bound, with every segment as an edge, and
/// refines it until triangles have the size asked for (`size`, per vertex of the chart's mesh), measured in
/// space. `keep`: per vertex of the surface, whether the mesh gets a vertex there if it is on no line; empty:
/// none.
/// Requires: the chart is indexed (index_chart); sizes are positive. Throws, naming the part: GoalMissed with
/// a point where segments cross or touch, points coincide or borders bound no region; GoalMissed if a size is
/// too small for the coordinates of the map or far more points are needed than expected; NotAdmissible if a
/// line point lies on an edge that the chart lacks.
PlaneMesh mesh_chart(const Chart& chart, const std::vector<double>& size, const PartLines& lines, int part,
                     Mesher mesher = Mesher::frontal, const std::vector<char>& keep = {});

}  // namespace meshpipe
