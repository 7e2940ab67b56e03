// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/chart_svg.h"

#include <algorithm>
#include <cmath>

#include "tools/report/svg.h"

namespace meshpipe {
namespace {

constexpr double side = 1000, gap = 50, head = 60;  ///< of one drawing, in units of the picture
constexpr int digits = 5;                           ///< of a coordinate: a twentieth of a unit at least

/// Where a drawing stands in the picture; v points up, as in the plane.
struct ChartFrame {
  Vec2 low, high;
  double scale, x;
  Vec2 operator()(Vec2 p) const { return {x + scale * (p.x - low.x), head + scale * (high.y - p.y)}; }
};

/// The triangles of a map or a mesh and their opposite half-edges.
struct Triangles {
  const std::vector<Tri>& tris;
  const std::vector<int>& opposite;
};

/// Returns the path of the edges that `chosen(half_edge)` wants, each once. `point(vertex)` is in the plane.
template <class Point, class Chosen>
SvgPath edges(const ChartFrame& frame, const Triangles& mesh, Point point, Chosen chosen) {
  SvgPath path(digits);
  for (int h = 0; h < 3 * (int)mesh.tris.size(); ++h) {
    if (mesh.opposite[h] > h || !chosen(h)) continue;
    path.move_to(frame(point(origin(mesh.tris, h))));
    path.line_to(frame(point(target(mesh.tris, h))));
  }
  return path;
}

}  // namespace

std::string chart_svg(const Chart& chart, const PlaneMesh& mesh, const std::string& title) {
  Vec2 low = chart.uv.at(0), high = low;
  for (Vec2 p : chart.uv) low = lower(low, p), high = upper(high, p);
  const double scale = side / std::max({high.x - low.x, high.y - low.y, 1e-300});
  const double width = scale * (high.x - low.x), height = scale * (high.y - low.y);
  const ChartFrame left{low, high, scale, gap}, right{low, high, scale, 2 * gap + width};
  // lines at most a tenth as thick as the triangles are wide
  auto thickness = [&](std::size_t triangles) {
    const double triangle =
        std::sqrt(width * height / static_cast<double>(std::max<std::size_t>(1, triangles)));
    return svg_number("stroke-width", std::clamp(0.1 * triangle, 0.1, 2.0));
  };
  const std::string map_line = thickness(chart.mesh.tris.size()), mesh_line = thickness(mesh.tris.size());
  auto map_point = [&](int v) { return chart.uv[v]; };
  auto mesh_point = [&](int v) { return mesh.points[v].uv; };
  auto all = [](int) { return true; };
  auto on_map_border = [&](int h) { return chart.opposite[h] < 0; };
  auto on_line = [&](int h) { return mesh.on_line[h] != 0; };

  Svg svg(2 * width + 3 * gap, height + head + gap, "fill=\"none\" stroke-linecap=\"round\"");
  svg.begin_group("font-family=\"sans-serif\" font-size=\"25\" fill=\"black\"");
  svg.text({gap, 30}, title + ", map: " + std::to_string(chart.mesh.tris.size()) + " triangles");
  svg.text({2 * gap + width, 30}, "mesh: " + std::to_string(mesh.tris.size()) + " triangles");
  svg.end_group();
  const Triangles map{chart.mesh.tris, chart.opposite}, result{mesh.tris, mesh.opposite};
  svg.path(edges(left, map, map_point, all), "stroke=\"#7090b0\" " + map_line);
  svg.path(edges(left, map, map_point, on_map_border), "stroke=\"black\" stroke-width=\"2\"");
  svg.path(edges(right, result, mesh_point, all), "stroke=\"#404040\" " + mesh_line);
  svg.path(edges(right, result, mesh_point, on_line), "stroke=\"#d95f02\" stroke-width=\"2\"");
  return svg.finish();
}

}  // namespace meshpipe
