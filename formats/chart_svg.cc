// SPDX-License-Identifier: BSD-3-Clause
#include "formats/chart_svg.h"

#include <algorithm>
#include <cmath>

namespace meshpipe {
namespace {

constexpr double side = 10000, gap = 500, head = 600;  // of one drawing, in the picture's units

/// A drawing's place in the picture; v points up, as in the plane.
struct Frame2d {
  Vec2 low, high;
  double scale, x;
  void add(std::string& path, char command, Vec2 p) const {
    path += command;
    path += std::to_string(std::lround(x + scale * (p.x - low.x)));
    path += ' ';
    path += std::to_string(std::lround(head + scale * (high.y - p.y)));
  }
};

/// Each edge of the triangles once: those that `chosen(half_edge)` wants. `point(vertex)` is its place.
template <class Point, class Chosen>
std::string edges(const Frame2d& frame, const std::vector<Tri>& tris, const std::vector<int>& opposite,
                  Point point, Chosen chosen) {
  std::string path;
  for (int h = 0; h < 3 * (int)tris.size(); ++h) {
    if (opposite[h] > h || !chosen(h)) continue;
    frame.add(path, 'M', point(origin(tris, h)));
    frame.add(path, 'L', point(target(tris, h)));
  }
  return path;
}

std::string stroke(const std::string& path, const char* color, double width) {
  return "<path d=\"" + path + "\" stroke=\"" + color + "\" stroke-width=\"" +
         std::to_string(std::max(1L, std::lround(width))) + "\"/>\n";
}

std::string text(double x, const std::string& words) {
  return "<text x=\"" + std::to_string(std::lround(x)) + "\" y=\"300\">" + words + "</text>\n";
}

}  // namespace

std::string chart_svg(const Chart& chart, const PlaneMesh& mesh, const std::string& title) {
  Vec2 low = chart.uv.at(0), high = low;
  for (Vec2 p : chart.uv) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double scale = side / std::max({high.x - low.x, high.y - low.y, 1e-300});
  const double width = scale * (high.x - low.x), height = scale * (high.y - low.y);
  const Frame2d left{low, high, scale, gap}, right{low, high, scale, 2 * gap + width};

  // lines a tenth as thick as the triangles are wide
  auto thickness = [&](std::size_t triangles) {
    return std::clamp(0.1 * std::sqrt(width * height / std::max<std::size_t>(1, triangles)), 1.0, 20.0);
  };
  const double map_line = thickness(chart.mesh.tris.size()), mesh_line = thickness(mesh.tris.size());
  auto map_point = [&](int v) { return chart.uv[v]; };
  auto mesh_point = [&](int v) { return mesh.points[v].uv; };
  auto all = [](int) { return true; };
  auto on_map_border = [&](int h) { return chart.opposite[h] < 0; };
  auto on_line = [&](int h) { return mesh.on_line[h] != 0; };

  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                    std::to_string(std::lround(2 * width + 3 * gap)) + " " +
                    std::to_string(std::lround(height + head + gap)) +
                    "\" fill=\"none\" stroke-linecap=\"round\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
                    "<g font-family=\"sans-serif\" font-size=\"250\" fill=\"black\">\n";
  out += text(gap, title + ", map: " + std::to_string(chart.mesh.tris.size()) + " triangles");
  out += text(2 * gap + width, "mesh: " + std::to_string(mesh.tris.size()) + " triangles");
  out += "</g>\n";
  out += stroke(edges(left, chart.mesh.tris, chart.opposite, map_point, all), "#7090b0", map_line);
  out += stroke(edges(left, chart.mesh.tris, chart.opposite, map_point, on_map_border), "black", 20);
  out += stroke(edges(right, mesh.tris, mesh.opposite, mesh_point, all), "#404040", mesh_line);
  out += stroke(edges(right, mesh.tris, mesh.opposite, mesh_point, on_line), "#d95f02", 20);
  return out + "</svg>\n";
}

}  // namespace meshpipe
