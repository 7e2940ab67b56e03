// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/chart.h"

#include <algorithm>

#include "lib/core/error.h"
#include "lib/core/predicates.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

int cell_of(double x, double low, double cells_per_unit, int n) {
  double c = (x - low) * cells_per_unit;
  return c >= n ? n - 1 : c > 0 ? (int)c : 0;  // NaN and what lies below go to the first cell
}

/// Calls visit(cell) for the cells that triangle t may meet: in each row of cells those in the x-range of the
/// triangle's piece there, so that slivers across the chart take the cells along them and not their whole
/// box.
template <class Visit>
void visit_cells(const ChartGrid& g, const std::array<Vec2, 3>& t, Visit visit) {
  auto [y_min, y_max] = std::minmax({t[0].y, t[1].y, t[2].y});
  int first = cell_of(y_min, g.low.y, g.cells_per_unit, g.rows);
  int last = cell_of(y_max, g.low.y, g.cells_per_unit, g.rows);
  double slack = 1e-6 / g.cells_per_unit;  // rounding never loses a triangle
  auto visit_row = [&](int row, double x0, double x1) {
    int c1 = cell_of(x1 + slack, g.low.x, g.cells_per_unit, g.columns);
    for (int c = cell_of(x0 - slack, g.low.x, g.cells_per_unit, g.columns); c <= c1; ++c)
      visit(row * g.columns + c);
  };
  if (first == last) {
    auto [x_min, x_max] = std::minmax({t[0].x, t[1].x, t[2].x});
    visit_row(first, x_min, x_max);
    return;
  }
  for (int row = first; row <= last; ++row) {
    double y0 = g.low.y + row / g.cells_per_unit - slack, y1 = y0 + 1 / g.cells_per_unit + 2 * slack;
    double x0 = infinity, x1 = -infinity;
    for (int i = 0; i < 3; ++i) {
      Vec2 a = t[i], b = t[(i + 1) % 3];
      if (a.y > b.y) std::swap(a, b);
      if (b.y < y0 || a.y > y1) continue;
      double rise = b.y - a.y;
      double from = rise > 0 ? std::clamp((y0 - a.y) / rise, 0.0, 1.0) : 0;
      double to = rise > 0 ? std::clamp((y1 - a.y) / rise, 0.0, 1.0) : 1;
      auto [lo, hi] = std::minmax({lerp(a, b, from).x, lerp(a, b, to).x});
      x0 = std::min(x0, lo);
      x1 = std::max(x1, hi);
    }
    if (x0 <= x1) visit_row(row, x0, x1);
  }
}

std::array<Vec2, 3> corners(const Chart& chart, int t) {
  const Tri& v = chart.mesh.tris[t];
  return {chart.uv[v[0]], chart.uv[v[1]], chart.uv[v[2]]};
}

bool holds(const Chart& chart, int t, Vec2 p) {
  auto [a, b, c] = corners(chart, t);
  return orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0;
}

Place place_inside(const Chart& chart, int t, Vec2 p) {
  auto [a, b, c] = corners(chart, t);
  // the exact tests say that p is inside, so a negative area is rounding
  double s0 = std::max(0.0, cross(b - p, c - p)), s1 = std::max(0.0, cross(c - p, a - p)),
         s2 = std::max(0.0, cross(a - p, b - p)), sum = s0 + s1 + s2;
  if (!(sum > 0)) return {t, 1, 0, 0};
  return {t, s0 / sum, s1 / sum, s2 / sum};
}

/// Keeps the border edge nearest to p among those looked at.
struct Nearest {
  const Chart& chart;
  Vec2 p;
  Place place;
  double distance2 = infinity;
  void look_at(int t) {
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (chart.opposite[h] >= 0) continue;
      const Vec2 a = chart.uv[origin(chart.mesh.tris, h)], b = chart.uv[target(chart.mesh.tris, h)];
      const double t = nearest_fraction(p, a, b);
      const Vec2 d = p - lerp(a, b, t);
      if (dot(d, d) < distance2) distance2 = dot(d, d), place = place_on_edge(h, 1 - t, t);
    }
  }
};

/// Without a walk: the triangle that holds p by its cell, else the border edge nearest to it by rings of
/// cells.
Place look_up(const Chart& chart, Vec2 p) {
  const ChartGrid& g = chart.grid;
  Nearest nearest{chart, p, {}};
  if (g.triangles.start.empty()) {
    for (int t = 0; t < (int)chart.mesh.tris.size(); ++t) {
      if (holds(chart, t, p)) return place_inside(chart, t, p);
      nearest.look_at(t);
    }
    return nearest.place;
  }
  int column = cell_of(p.x, g.low.x, g.cells_per_unit, g.columns);
  int row = cell_of(p.y, g.low.y, g.cells_per_unit, g.rows);
  for (int t : g.triangles[row * g.columns + column])
    if (holds(chart, t, p)) return place_inside(chart, t, p);
  for (int ring = 0; ring < std::max(g.columns, g.rows); ++ring) {
    // everything in this ring and beyond is at least ring - 1 cells away, whether p is in its cell or outside
    // the grid
    double away = (ring - 1) / g.cells_per_unit;
    if (away > 0 && away * away > nearest.distance2) break;
    for (int r = std::max(0, row - ring); r <= std::min(g.rows - 1, row + ring); ++r) {
      bool edge_row = r == row - ring || r == row + ring;
      for (int c = column - ring; c <= column + ring; c += edge_row || ring == 0 ? 1 : 2 * ring) {
        if (c < 0 || c >= g.columns) continue;
        int cell = r * g.columns + c;
        for (int t : g.triangles[cell]) nearest.look_at(t);
      }
    }
  }
  return nearest.place;
}

}  // namespace

Place place_on_edge(int h, double from, double to) {
  double b[3] = {0, 0, 0};
  b[h % 3] = from;
  b[(h + 1) % 3] = to;
  return {h / 3, b[0], b[1], b[2]};
}

void index_chart(Chart& chart) {
  const auto& tris = chart.mesh.tris;
  chart.opposite = opposite_halfedges(tris, (int)chart.uv.size());
  Vec2 low{infinity, infinity}, high{-infinity, -infinity};
  for (Vec2 p : chart.uv) low = lower(low, p), high = upper(high, p);
  ChartGrid& g = chart.grid;
  g = {};
  double width = high.x - low.x, height = high.y - low.y;
  if (!(width > 0 && height > 0)) return;  // no triangle, or all flat
  // square cells, about one for two triangles
  g.low = low;
  g.cells_per_unit = std::sqrt(0.5 * (double)tris.size() / (width * height));
  g.cells_per_unit = std::min(g.cells_per_unit, (double)tris.size() / std::max(width, height));
  g.columns = (int)(width * g.cells_per_unit) + 1;
  g.rows = (int)(height * g.cells_per_unit) + 1;
  std::vector<int> cells, end;  // of each triangle
  cells.reserve(4 * tris.size());
  end.reserve(tris.size());
  for (int t = 0; t < (int)tris.size(); ++t) {
    visit_cells(g, corners(chart, t), [&](int cell) { cells.push_back(cell); });
    end.push_back((int)cells.size());
  }
  g.triangles = lists_of(g.columns * g.rows, [&](auto use) {
    for (int t = 0, i = 0; t < (int)tris.size(); ++t)
      for (; i < end[t]; ++i) use(cells[i], t);
  });
}

std::vector<Chart> make_charts(const Surface& surface, const Table& chart_vertex, int n_parts) {
  const auto& part = chart_vertex.get<int>("part");
  const auto& vertex = chart_vertex.get<int>("vertex");
  const auto& u = chart_vertex.get<double>("u");
  const auto& v = chart_vertex.get<double>("v");
  int n_rows = (int)part.size(), n_vertices = (int)surface.points.size();
  auto row_name = [&](int row) { return "chart_vertex row " + std::to_string(row); };

  for (int r = 0; r < n_rows; ++r) {
    if (part[r] < 0 || part[r] >= n_parts)
      throw BadInput(row_name(r) + " names part " + std::to_string(part[r]) + ", but there are " +
                     std::to_string(n_parts));
    if (vertex[r] < 0 || vertex[r] >= n_vertices)
      throw BadInput(row_name(r) + " names vertex " + std::to_string(vertex[r]) + ", but there are " +
                     std::to_string(n_vertices));
  }
  const Lists rows = lists_by(n_parts, part);

  std::vector<SubMesh> parts = split_by_label(surface, surface.face.get<int>("part"), n_parts);
  std::vector<Chart> charts(n_parts);
  std::vector<int> local(n_vertices, -1);
  for (int p = 0; p < n_parts; ++p) {
    Chart& chart = charts[p];
    chart.mesh = std::move(parts[p]);
    int n = (int)chart.mesh.vertex.size();
    for (int i = 0; i < n; ++i) local[chart.mesh.vertex[i]] = i;
    chart.uv.resize(n);
    std::vector<char> seen(n, 0);
    for (int r : rows[p]) {
      const int i = local[vertex[r]];
      if (i < 0)
        throw BadInput(row_name(r) + " puts vertex " + std::to_string(vertex[r]) + " in part " +
                       std::to_string(p) + ", which does not have it");
      if (seen[i])
        throw BadInput(row_name(r) + " doubles vertex " + std::to_string(vertex[r]) + " of part " +
                       std::to_string(p));
      seen[i] = 1;
      chart.uv[i] = {u[r], v[r]};
    }
    for (int i = 0; i < n; ++i) {
      if (!seen[i])
        throw BadInput("chart_vertex has no row for vertex " + std::to_string(chart.mesh.vertex[i]) +
                       " of part " + std::to_string(p));
      local[chart.mesh.vertex[i]] = -1;
    }
    for (int t = 0; t < (int)chart.mesh.tris.size(); ++t) {
      auto [a, b, c] = corners(chart, t);
      if (orient2d(a, b, c) <= 0)
        throw BadInput("chart_vertex turns face " + std::to_string(chart.mesh.face[t]) + " of part " +
                       std::to_string(p) + " over or makes it flat");
    }
  }
  return charts;
}

Place locate(const Chart& chart, Vec2 p, int hint) {
  int n = (int)chart.mesh.tris.size();
  int t = 0 <= hint && hint < n ? hint : 0;
  // Not in a Delaunay triangulation, a walk that always takes the same way out of a triangle may go round in
  // circles: the first edge tested is chosen at random (Devillers, Pion, Teillaud 2002), the same for every
  // call.
  unsigned random = 12345;
  int entered = -1;
  int bound = 100 + 8 * (int)std::sqrt((double)n);
  for (int step = 0; step < bound; ++step) {
    random = 1664525 * random + 1013904223;
    int go = -1;
    bool outside = false;
    for (int k = 0, i = (int)((random >> 16) % 3); k < 3 && go < 0; ++k, i = i == 2 ? 0 : i + 1) {
      int h = 3 * t + i;
      if (h == entered) continue;
      const Tri& v = chart.mesh.tris[t];
      if (orient2d(chart.uv[v[i]], chart.uv[v[i == 2 ? 0 : i + 1]], p) >= 0) continue;
      outside = true;
      go = chart.opposite[h];
    }
    if (!outside) return place_inside(chart, t, p);
    if (go < 0) break;
    entered = go;
    t = go / 3;
  }
  return look_up(chart, p);
}

}  // namespace meshpipe
