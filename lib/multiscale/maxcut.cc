// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/maxcut.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "lib/numeric/laplacian.h"

namespace meshpipe {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double smallest_image = 1e-15;  // of the paper's Fig. 2

}  // namespace

MaxCut max_cut(const FilledDisk& disk) {
  MaxCut cut;
  Level& level = cut.level;
  level.tris.resize(disk.tris.size());
  std::iota(level.tris.begin(), level.tris.end(), 0);
  level.corners = disk.tris;
  level.vertex.resize(disk.points.size());
  std::iota(level.vertex.begin(), level.vertex.end(), 0);
  for (std::size_t v = disk.part_vertices; v < disk.points.size(); v++) level.holes.push_back(v);

  level.uv.resize(disk.points.size());
  std::vector<char> fixed(disk.points.size(), 0);
  const std::size_t n_rim = disk.rim.size();
  auto step = [&](std::size_t i) {
    return norm(disk.points[disk.rim[(i + 1) % n_rim]] - disk.points[disk.rim[i]]);
  };
  double total = 0, at = 0;
  for (std::size_t i = 0; i < n_rim; i++) total += step(i);
  for (std::size_t i = 0; i < n_rim; i++) {
    fixed[disk.rim[i]] = 1;
    level.uv[disk.rim[i]] = {std::cos(2 * pi * at / total), std::sin(2 * pi * at / total)};
    at += step(i);
  }
  solve_dirichlet(disk.tris, disk.weights, fixed, level.uv);
  for (int t = 0; t < disk.part_tris; t++) {
    const Tri& c = disk.tris[t];
    const double area = cross(level.uv[c[1]] - level.uv[c[0]], level.uv[c[2]] - level.uv[c[0]]) / 2;
    cut.too_small += std::abs(area) < smallest_image;
    cut.reversed += !(area > 0);
  }

  Vec2 center;
  for (int v = 0; v < disk.part_vertices; v++) center = center + (1. / disk.part_vertices) * level.uv[v];
  double xx = 0, xy = 0, yy = 0;
  for (int v = 0; v < disk.part_vertices; v++) {
    const Vec2 d = center - level.uv[v];
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  const double angle = std::atan2(2 * xy, xx - yy) / 2;
  const Vec2 along{std::cos(angle), std::sin(angle)};
  cut.line = {center - 3 * along, center + 3 * along};
  cut.field.resize(disk.part_vertices);
  for (int v = 0; v < disk.part_vertices; v++) {
    const double side = cross(along, level.uv[v] - center);
    cut.field[v] =
        std::abs(side) < std::numeric_limits<double>::min() ? std::numeric_limits<double>::min() : side;
  }
  return cut;
}

}  // namespace meshpipe
