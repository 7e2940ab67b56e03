// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <variant>

#include "lib/core/bvh.h"
#include "lib/core/edit_mesh.h"
#include "lib/core/normals.h"
#include "lib/core/topology.h"
#include "lib/defeature/defeature.h"

namespace meshpipe {
namespace {

constexpr double rounding = 3e-6;    ///< of the diagonal: single-precision coordinates, with a margin
constexpr double least_end = 1e-3;   ///< of the edge: a corner nearer to its end makes a needle there
constexpr double flat_fold = -0.99;  ///< cosine between the normals of a pair that lies flat on itself
constexpr int most_passes = 20;      ///< one for each row of caps that lean on each other

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

/// Whether the triangles of h lie flat on each other, and would no more if it were flipped: the edge, which
/// goes, is within the tolerance of what is there then.
bool is_fold(const EditMesh& m, const std::vector<Vec3>& points, int h, double tolerance) {
  const int o = m.opp[h];
  if (m.hard[h]) return false;
  auto normal = [&](int t) {
    return area_vector(points[m.tris[t][0]], points[m.tris[t][1]], points[m.tris[t][2]]);
  };
  const Vec3 n = normal(h / 3), k = normal(o / 3);
  if (!(dot(n, k) < flat_fold * norm(n) * norm(k))) return false;
  const Vec3 a = points[m.from(h)], b = points[m.to(h)], c = points[m.apex(h)], d = points[m.apex(o)];
  if (!(dot(area_vector(a, d, c), n + k) > 0) || !(dot(area_vector(b, c, d), n + k) > 0)) return false;
  std::vector<std::array<Vec3, 3>> around{{a, d, c}, {b, c, d}};
  for (int e : {next(h), prev(h), next(o), prev(o)})
    if (const int g = m.opp[e]; g >= 0)
      around.push_back({points[m.from(g)], points[m.to(g)], points[m.apex(g)]});
  for (double x : {0.25, 0.5, 0.75}) {
    const Vec3 p = lerp(a, b, x);
    auto near = [&](const std::array<Vec3, 3>& t) {
      const auto w = closest_on_triangle(p, t[0], t[1], t[2]);
      return norm(w[0] * t[0] + w[1] * t[1] + w[2] * t[2] - p) <= tolerance;
    };
    if (std::none_of(around.begin(), around.end(), near)) return false;
  }
  return !m.joined(m.apex(h), m.apex(o));
}

}  // namespace

int flip_caps(Surface& surface, const std::vector<int>& line, double tolerance) {
  const std::vector<int> opposite = opposite_halfedges(surface);
  const double least = rounding * diagonal(surface);
  const std::vector<Vec3> normal = face_normals(surface);
  auto is_low = [&](int t) {
    const Tri& v = surface.tris[t];
    return height(surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]) < least;
  };
  bool any = false;
  for (int h = 0; h < (int)opposite.size() && !any; ++h)
    any = (h % 3 == 0 && is_low(h / 3)) ||
          (opposite[h] > h && dot(normal[h / 3], normal[opposite[h] / 3]) < flat_fold);
  if (!any) return 0;
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
      int h = longest_edge(surface, t);
      if (!is_cap(m, surface.points, h, least)) {
        for (h = 3 * t; h < 3 * t + 3 && !is_fold(m, surface.points, h, tolerance);) ++h;
        if (h == 3 * t + 3) continue;
      }
      int large = m.opp[h] / 3, small = t;
      if (triangle_area(surface, small) > triangle_area(surface, large)) std::swap(small, large);
      m.flip(h);
      surface.tris[small] = m.tris[small], surface.tris[large] = m.tris[large];
      for (Column& column : surface.face.columns)
        std::visit([&](auto& values) { values[small] = values[large]; }, column.data);
      ++all;
    }
  }
  return all;
}

}  // namespace meshpipe
