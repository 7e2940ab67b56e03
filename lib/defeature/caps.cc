// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <variant>

#include "lib/core/edit_mesh.h"
#include "lib/core/topology.h"
#include "lib/defeature/defeature.h"

namespace meshpipe {
namespace {

constexpr double rounding = 3e-6;   ///< of the diagonal: single-precision coordinates, with a margin
constexpr double least_end = 1e-3;  ///< of the edge: a corner nearer to its end makes a needle there
constexpr int most_passes = 20;     ///< one for each row of caps that lean on each other

/// Height of a triangle over the longest of its edges.
double height(Vec3 a, Vec3 b, Vec3 c) {
  const double l = std::max({norm(b - a), norm(c - b), norm(a - c)});
  return l > 0 ? norm(area_vector(a, b, c)) / l : 0;
}

int longest_edge(const Mesh& mesh, int t) {
  int h = 3 * t;
  for (int g : {3 * t + 1, 3 * t + 2})
    if (edge_length(mesh, g) > edge_length(mesh, h)) h = g;
  return h;
}

/// Whether the triangle of h, its longest edge, is lower than `least`, and the edge may be flipped.
bool is_cap(const EditMesh& m, const std::vector<Vec3>& points, int h, double least) {
  if (m.hard[h]) return false;
  const Vec3 a = points[m.from(h)], b = points[m.to(h)], c = points[m.apex(h)], d = points[m.apex(m.opp[h])];
  const double low = height(a, b, c), at = dot(c - a, b - a) / dot(b - a, b - a);
  const Vec3 up = area_vector(b, a, d);
  return low < least && std::min(at, 1 - at) > least_end && dot(area_vector(c, a, d), up) > 0 &&
         dot(area_vector(d, b, c), up) > 0 && std::min(height(c, a, d), height(d, b, c)) > low &&
         !m.joined(m.apex(h), m.apex(m.opp[h]));
}

}  // namespace

int flip_caps(Surface& surface, const std::vector<int>& line) {
  const double least = rounding * diagonal(surface);
  auto is_low = [&](const Tri& v) {
    return height(surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]) < least;
  };
  if (std::none_of(surface.tris.begin(), surface.tris.end(), is_low)) return 0;
  const std::vector<int> opposite = opposite_halfedges(surface);
  EditMesh m(Connectivity{surface, opposite});
  for (const char* name : {"patch", "part"}) {
    if (!surface.face.has(name)) continue;
    const auto& label = surface.face.get<int>(name);
    for (int h = 0; h < (int)m.opp.size(); ++h)
      if (const int o = m.opp[h]; o >= 0 && label[h / 3] != label[o / 3]) m.hard[h] = 1;
  }
  for (int h = 0; h < (int)m.opp.size(); ++h)
    if (const int o = m.opp[h]; o >= 0 && (line[h] >= 0 || line[o] >= 0)) m.hard[h] = 1;
  int all = 0;
  for (int pass = 0, before = -1; pass < most_passes && all != before; ++pass) {
    before = all;
    for (int t = 0; t < (int)m.tris.size(); ++t) {
      const int h = longest_edge(surface, t);
      if (!is_cap(m, surface.points, h, least)) continue;
      const int u = m.opp[h] / 3;
      m.flip(h);
      surface.tris[t] = m.tris[t], surface.tris[u] = m.tris[u];
      for (Column& column : surface.face.columns)
        std::visit([&](auto& values) { values[t] = values[u]; }, column.data);
      ++all;
    }
  }
  return all;
}

}  // namespace meshpipe
