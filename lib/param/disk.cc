// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/disk.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "lib/core/error.h"
#include "lib/core/topology.h"
#include "lib/param/intrinsic.h"

namespace meshpipe {
namespace {

using std::numbers::pi;
constexpr double flat_to = 0.1;  // radians from 2 pi, by which a hole's border turns on a flat part

std::vector<double> lengths_of(const SubMesh& part, const std::vector<int>& loop) {
  std::vector<double> length;
  for (int h : loop) length.push_back(edge_length(part, h));
  return length;
}

/// Isosceles triangles around a center, over the edges of a loop.
void add_round_fan(const SubMesh& part, const std::vector<int>& loop, double length, int center,
                   Filled& filled) {
  for (int h : loop) {
    double l = edge_length(part, h), angle = std::clamp(2 * pi * l / length, 1e-4, 0.75 * pi);
    if (!(l > 0)) l = 1e-9 * length;
    filled.tris.push_back({target(part.tris, h), origin(part.tris, h), center});
    filled.shape.push_back({Vec3{0, 0, 0}, {l, 0, 0}, {l / 2, l / 2 / std::tan(angle / 2), 0}});
  }
}

/// The same of the loop's polygon, or false if that is not star-shaped around the mean of its corners.
bool add_polygon_fan(const SubMesh& part, const std::vector<int>& loop, const std::vector<Vec2>& polygon,
                     int center, Filled& filled) {
  if (polygon.empty()) return false;
  std::size_t n = loop.size();
  Vec2 middle;
  for (Vec2 p : polygon) middle = middle + (1 / (double)n) * p;
  for (std::size_t i = 0; i < n; ++i) {
    // the part is on the left of the loop and the hole on its right
    Vec2 a = polygon[i] - middle, b = polygon[(i + 1) % n] - middle;
    if (!(cross(b, a) > 0.01 * dot(b - a, b - a))) return false;
  }
  for (std::size_t i = 0; i < n; ++i) {
    Vec2 a = polygon[i], b = polygon[(i + 1) % n];
    filled.tris.push_back({target(part.tris, loop[i]), origin(part.tris, loop[i]), center});
    filled.shape.push_back({Vec3{b.x, b.y, 0}, {a.x, a.y, 0}, {middle.x, middle.y, 0}});
  }
  return true;
}

template <class Visit>
void for_each_spring(const Filled& filled, const std::vector<double>& weights, Visit visit) {
  for (int h = 0; h < (int)weights.size(); ++h)
    visit(origin(filled.tris, h), target(filled.tris, h), weights[h]);
}

}  // namespace

Disk disk_of(const SubMesh& part) {
  Disk d;
  int n = (int)part.points.size();
  d.opposite = opposite_halfedges(part.tris, n);
  if (int v = find_pinched_vertex(part.tris, d.opposite, n); v >= 0)
    throw NotAdmissible("the part touches itself at vertex " + std::to_string(part.vertex[v]) +
                        "; run mpartition first");
  std::vector<int> component;
  int n_components = components(d.opposite, component);
  d.loops = boundary_loops(d.opposite);
  int n_border = 0;
  std::size_t longest = 0;
  for (const auto& loop : d.loops) {
    d.length.push_back(loop_length(part, loop));
    n_border += (int)loop.size();
    if (d.length.back() > d.length[longest]) longest = d.length.size() - 1;
  }
  int n_loops = (int)d.loops.size(), n_tris = (int)part.tris.size();
  int euler = n - (3 * n_tris + n_border) / 2 + n_tris;
  if (n_components != 1 || n_loops == 0 || euler != 2 - n_loops)
    throw NotAdmissible("not a disk with holes: components " + std::to_string(n_components) + ", genus " +
                        std::to_string((2 * n_components - euler - n_loops) / 2) + ", loops " +
                        std::to_string(n_loops) + "; run mpartition first");
  std::swap(d.loops[0], d.loops[longest]);
  std::swap(d.length[0], d.length[longest]);
  return d;
}

Filled open_holes(const SubMesh& part) {
  Filled filled;
  filled.n_vertices = (int)part.points.size();
  filled.tris = part.tris;
  filled.shape.reserve(part.tris.size());
  for (const Tri& t : part.tris)
    filled.shape.push_back({part.points[t[0]], part.points[t[1]], part.points[t[2]]});
  return filled;
}

Filled round_holes(const SubMesh& part, const Disk& disk) {
  Filled filled = open_holes(part);
  for (std::size_t l = 1; l < disk.loops.size(); ++l)
    add_round_fan(part, disk.loops[l], disk.length[l], filled.n_vertices++, filled);
  return filled;
}

Filled flat_holes(const SubMesh& part, const Disk& disk) {
  Filled filled = open_holes(part);
  std::vector<double> turn(part.points.size(), pi);  // of the holes' borders, on the part
  std::vector<char> of_hole(part.points.size(), 0);
  for (std::size_t l = 1; l < disk.loops.size(); ++l)
    for (int h : disk.loops[l]) of_hole[origin(part.tris, h)] = 1;
  for (const Tri& t : part.tris)
    for (int i = 0; i < 3; ++i)
      if (of_hole[t[i]]) {
        const Vec3 p = part.points[t[i]];
        turn[t[i]] -= angle(part.points[t[(i + 1) % 3]] - p, part.points[t[(i + 2) % 3]] - p);
      }
  for (std::size_t l = 1; l < disk.loops.size(); ++l) {
    const auto& loop = disk.loops[l];
    double sum = 0;
    for (int h : loop) sum -= turn[origin(part.tris, h)];
    const bool flat = std::abs(sum - 2 * pi) < flat_to;
    const int center = filled.n_vertices++;
    if (!flat ||
        !add_polygon_fan(part, loop, polygon_of(part, loop, turn, lengths_of(part, loop)), center, filled))
      add_round_fan(part, loop, disk.length[l], center, filled);
  }
  return intrinsic_delaunay(std::move(filled));
}

std::vector<double> cotangents(const Shapes& shapes, double floor, double ceiling) {
  std::vector<double> weights;
  weights.reserve(3 * shapes.size());
  for (const auto& [a, b, c] : shapes)
    for (double w : cotangent_weights(a, b, c, floor)) weights.push_back(std::min(w, 0.5 * ceiling));
  return weights;
}

std::vector<double> angle_sums(const Filled& filled, const std::vector<double>& cotangents) {
  std::vector<double> sum(filled.n_vertices, 0);
  for (int h = 0; h < (int)cotangents.size(); ++h)
    sum[origin(filled.tris, prev(h))] += std::atan2(1, 2 * cotangents[h]);
  return sum;
}

Factorization<double> laplacian(const Filled& filled, const std::vector<double>& weights,
                                const std::vector<int>& unknown, int n) {
  Laplacian matrix(n);
  matrix.reserve(weights.size());
  for_each_spring(filled, weights,
                  [&](int a, int b, double w) { matrix.add_edge(unknown[a], unknown[b], w); });
  return matrix.factorize(MatrixKind::laplacian);
}

std::vector<double> turns(const Filled& filled, const std::vector<double>& weights,
                          const std::vector<double>& angle_sum, const std::vector<double>& scale) {
  std::vector<double> turn(scale.size());
  for (std::size_t v = 0; v < turn.size(); ++v) turn[v] = pi - angle_sum[v];
  for_each_spring(filled, weights, [&](int a, int b, double w) {
    turn[a] += w * (scale[a] - scale[b]);
    turn[b] += w * (scale[b] - scale[a]);
  });
  return turn;
}

std::vector<Vec2> polygon_of(const SubMesh& part, const std::vector<int>& loop,
                             const std::vector<double>& turn, const std::vector<double>& length) {
  std::vector<Vec2> direction, polygon;
  double heading = 0, xx = 0, xy = 0, yy = 0;
  Vec2 gap, at;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    heading += turn[origin(part.tris, loop[i])];
    Vec2 d{std::cos(heading), std::sin(heading)};
    double l = length[i];
    xx += l * d.x * d.x;
    xy += l * d.x * d.y;
    yy += l * d.y * d.y;
    gap = gap + l * d;
    direction.push_back(d);
  }
  double det = xx * yy - xy * xy;
  Vec2 c{(yy * gap.x - xy * gap.y) / det, (xx * gap.y - xy * gap.x) / det};
  for (std::size_t i = 0; i < loop.size(); ++i) {
    polygon.push_back(at);
    double stretch = 1 - dot(c, direction[i]);
    if (!(stretch > 0)) return {};
    at = at + stretch * length[i] * direction[i];
  }
  if (!std::isfinite(at.x) || !std::isfinite(at.y)) return {};
  return polygon;
}

void scale_to_area(const SubMesh& part, std::vector<Vec2>& uv) {
  double area = 0;
  for (const Tri& t : part.tris) area += 0.5 * cross(uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]]);
  const double space = total_area(part);
  if (!(area > 0 && space > 0)) return;
  double s = std::sqrt(space / area);
  for (Vec2& p : uv) p = s * p;
}

}  // namespace meshpipe
