// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/partition.h"

#include <algorithm>
#include <string>

#include "lib/core/regions.h"
#include "lib/core/topology.h"

namespace meshpipe {
bool is_crease(const Connectivity& mesh, int h) {
  return mesh.is_model(h) ||
         angle(mesh.area_vector(h / 3), mesh.area_vector(mesh.opposite[h] / 3)) > sharp_edge;
}

Interfaces measure_interfaces(const Connectivity& view, const std::vector<int>& part) {
  const std::vector<int>& opposite = view.opposite;
  const std::vector<Tri>& tris = view.mesh.tris;
  const std::vector<Vec3>& points = view.mesh.points;
  Interfaces r;
  auto is_interface = [&](int h) { return opposite[h] >= 0 && part[h / 3] != part[opposite[h] / 3]; };
  std::vector<int> count(points.size(), 0), leaving(points.size(), -1);
  std::vector<char> crease(points.size(), 0);
  for (int h = 0; h < (int)opposite.size(); ++h) {
    if (!is_interface(h)) continue;
    const int a = origin(tris, h), b = target(tris, h);
    ++count[a];
    leaving[a] = h;
    if (opposite[h] < h) continue;
    r.length += view.length(h);
    if (is_crease(view, h)) crease[a] = crease[b] = 1;
  }
  if (r.length > 0) r.length /= diagonal(view.mesh);
  using std::numbers::pi;
  std::vector<double> turning;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (count[v] > 2) ++r.junctions;
    if (count[v] != 2 || crease[v]) continue;
    double sides[2] = {0, 0};
    int side = 1;  // changes at both interface edges, the first of which is where the walk begins
    const bool closed = view.for_each_spoke(leaving[v], [&](int h) {
      if (is_interface(h)) side = 1 - side;
      sides[side] += angle(points[target(tris, h)] - points[v], points[origin(tris, prev(h))] - points[v]);
    });
    if (closed) turning.push_back(pi * std::abs(sides[0] - sides[1]) / (sides[0] + sides[1]));
  }
  if (turning.empty()) return r;
  auto quantile = turning.begin() + (std::ptrdiff_t)(turning.size() * 9 / 10);
  std::nth_element(turning.begin(), quantile, turning.end());
  r.turning_angle = *quantile * 180 / pi;
  r.largest_angle = *std::max_element(quantile, turning.end()) * 180 / pi;
  return r;
}

std::string part_fault(const Connectivity& mesh, const std::vector<int>& part) {
  if (part.empty()) return {};
  const auto [least, most] = std::minmax_element(part.begin(), part.end());
  if (*least < 0) return "part " + std::to_string(*least) + " is negative";
  const int n = *most + 1;
  if (n > (int)part.size())
    return "part " + std::to_string(*most) + ", but there are " + std::to_string(part.size()) + " triangles";
  const Regions regions = find_regions(mesh, part, n);
  std::vector<int> piece = part;
  const int n_pieces = separate_pieces(mesh, piece);
  std::vector<int> first(n_pieces, -1), pieces(n, 0);
  for (std::size_t t = 0; t < part.size(); ++t)
    if (first[piece[t]] < 0) first[piece[t]] = part[t], ++pieces[part[t]];
  for (int p = 0; p < n; ++p) {
    const Region& r = regions.region[p];
    const std::string name = "part " + std::to_string(p);
    if (r.faces == 0) return name + " of " + std::to_string(n) + " has no triangles";
    if (pieces[p] > 1) return name + " has " + std::to_string(pieces[p]) + " pieces";
    if (r.pinched) {
      std::vector<int> v;
      for (int h : regions.border[p]) v.push_back(mesh.from(h));
      std::sort(v.begin(), v.end());
      return name + " touches itself at vertex " + std::to_string(*std::adjacent_find(v.begin(), v.end()));
    }
    if (r.loops == 0) return name + " has no boundary";
    if (r.genus() != 0) return name + " has genus " + std::to_string(r.genus());
  }
  return {};
}

}  // namespace meshpipe
