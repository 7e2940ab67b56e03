// SPDX-License-Identifier: BSD-3-Clause
// A chart: one part of the surface with its map to the plane, and how to find points in it.
#pragma once
#include <string>

#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// A uniform grid of square cells over a chart, with the triangles that may meet each cell.
struct ChartGrid {
  Vec2 low;
  double cells_per_unit = 0;
  int columns = 0, rows = 0;  ///< cell c = row * columns + column
  Lists triangles;            ///< by cell
};

/// A part of a surface and its map: uv[i] is the image of mesh.points[i]; images have positive orientation.
struct Chart {
  SubMesh mesh;
  std::vector<Vec2> uv;
  std::vector<int> opposite;  ///< half-edges within the chart
  ChartGrid grid;             ///< set by index_chart; while it is empty, locate scans instead
};

/// Sets `opposite` and `grid` from the triangles and uv, in near-linear time. `grid` stays empty if the
/// images have no extent. Throws: as opposite_halfedges.
void index_chart(Chart& chart);

/// A place in a chart or on a surface: barycentric coordinates b0 + b1 + b2 = 1 of triangle `face`.
struct Place {
  int face = -1;
  double b0 = 1, b1 = 0, b2 = 0;
};
/// Returns the place on half-edge h with weight `from` of its origin and `to` of its target (their sum is 1).
Place place_on_edge(int h, double from, double to);
/// Returns the corner (0, 1, 2) with the largest weight, the first of equals.
inline int nearest_corner(const Place& p) { return p.b0 >= p.b1 && p.b0 >= p.b2 ? 0 : p.b1 >= p.b2 ? 1 : 2; }
/// Interpolates values given per vertex at a place; `tris` are the triangles that its `face` counts.
template <class T>
T value_at(const Place& p, const std::vector<T>& values, const std::vector<Tri>& tris) {
  const Tri& v = tris[p.face];
  return p.b0 * values[v[0]] + p.b1 * values[v[1]] + p.b2 * values[v[2]];
}

/// Builds a chart for each part 0..n_parts-1 of a surface (face column `part`) from the rows of table
/// chart_vertex (columns part, vertex, u, v); without index_chart. Throws: BadInput if a row is missing,
/// doubled or out of range, or a triangle is not positively oriented.
std::vector<Chart> make_charts(const Surface& surface, const Table& chart_vertex, int n_parts);

/// Returns the place in the chart of p, a point of the plane, by a walk from triangle `hint` with exact
/// orientation tests; where a border stops the walk, p is looked up in the grid. A point outside gets the
/// nearest place on the border. Requires: the chart has triangles, and `opposite` is set; an empty `grid`
/// only makes it slow. Never fails.
Place locate(const Chart& chart, Vec2 p, int hint);

/// Finds the images of vertices in table chart_vertex. Keeps references to the table's columns.
class ChartRows {
 public:
  ChartRows(Table& table, std::size_t n_vertices)
      : part_(table.get<int>("part")),
        vertex_(table.get<int>("vertex")),
        u_(table.get<double>("u")),
        v_(table.get<double>("v")),
        rows_(lists_by((int)n_vertices, vertex_)) {}
  /// Returns the image of a vertex in the chart of a part. Throws: BadInput if there is no row for it.
  Vec2 uv(int part, int vertex) const {
    for (int r : rows_[vertex])
      if (part_[r] == part) return {u_[r], v_[r]};
    throw BadInput("chart_vertex has no row for vertex " + std::to_string(vertex) + " in part " +
                   std::to_string(part));
  }

 private:
  const std::vector<int>&part_, &vertex_;
  const std::vector<double>&u_, &v_;
  const Lists rows_;
};

}  // namespace meshpipe
