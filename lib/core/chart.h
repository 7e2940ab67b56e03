// SPDX-License-Identifier: BSD-3-Clause
// A chart: one part of the surface with its map to the plane, and how to find points in it.
#pragma once
#include "lib/core/lists.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Triangles by the cells of a uniform grid over the chart: triangle[start[c]..start[c+1]) may meet cell c.
struct ChartGrid {
  Vec2 low;
  double cells_per_unit = 0;
  int columns = 0, rows = 0;  ///< cell c = row * columns + column
  Lists triangles;            ///< by cell
};

/// uv[i] belongs to mesh.points[i]; every triangle is positively oriented in the plane.
struct Chart {
  SubMesh mesh;
  std::vector<Vec2> uv;
  std::vector<int> opposite;  ///< half-edges within the chart
  ChartGrid grid;             ///< set by index_chart; while it is empty, locate scans instead
};

/// Sets opposite and grid from the triangles and uv; near-linear time.
void index_chart(Chart& chart);

/// A place in a chart or on a surface: barycentric coordinates b0 + b1 + b2 = 1 of triangle `face`.
struct Place {
  int face = -1;
  double b0 = 1, b1 = 0, b2 = 0;
};
/// Returns the place on half-edge h with these weights of its ends.
Place place_on_edge(int h, double from, double to);
/// Returns the corner of the largest weight.
inline int nearest_corner(const Place& p) { return p.b0 >= p.b1 && p.b0 >= p.b2 ? 0 : p.b1 >= p.b2 ? 1 : 2; }
/// Interpolates values at the vertices of a place's triangle.
template <class T>
T value_at(const Place& p, const std::vector<T>& values, const std::vector<Tri>& tris) {
  const Tri& v = tris[p.face];
  return p.b0 * values[v[0]] + p.b1 * values[v[1]] + p.b2 * values[v[2]];
}

/// Builds the charts of a surface from its part labels and the rows of the stream's chart_vertex table
/// (part, vertex, u, v), not indexed. Throws BadInput if a row is missing, doubled or out of range, or a
/// triangle is not positively oriented.
std::vector<Chart> make_charts(const Surface& surface, const Table& chart_vertex, int n_parts);

/// Finds the triangle of the chart that holds p, walking from triangle `hint` by exact orientation tests;
/// where the walk is stopped by a border that is not convex, it looks p up in the grid. A point outside the
/// chart gets the nearest place on its border (barycentrics clamped to [0,1]). Requires: the chart has
/// triangles and its `opposite` is set (index_chart); `grid` may be empty. Then it never fails.
Place locate(const Chart& chart, Vec2 p, int hint);

}  // namespace meshpipe
