// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>
#include <variant>

#include "lib/core/bvh.h"
#include "lib/core/edit_mesh.h"
#include "lib/core/farthest.h"
#include "lib/core/fold.h"
#include "lib/core/normals.h"
#include "lib/defeature/defeature.h"

namespace meshpipe {
namespace {

constexpr double rounding = 3e-6;     ///< of the diagonal: single-precision coordinates, with a margin
constexpr double nearest_end = 1e-3;  ///< of the edge: a corner nearer to its end makes a needle there
constexpr double flat = 0.05;         ///< of the longest edge: a higher triangle has a normal of its own
constexpr double same_side = 0.5;     ///< cosine between normals: what is bent more has an edge there
constexpr double least_turn = std::numbers::pi / 2;  ///< around a corner of a fold
constexpr int most_rows = 20;                        ///< one for each row of caps that lean on each other

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

/// Whether the triangle of h, its longest edge, is lower than `least`, and the edge may be flipped. One that
/// is small, but not flat, is not flipped across a crease.
bool is_cap(const EditMesh& m, const std::vector<Vec3>& points, int h, double least) {
  if (m.hard[h]) return false;
  const Vec3 a = points[m.from(h)], b = points[m.to(h)], c = points[m.apex(h)], d = points[m.apex(m.opp[h])];
  const double low = height(a, b, c), at = dot(c - a, b - a) / dot(b - a, b - a);
  const Vec3 up = area_vector(b, a, d);
  const bool bent =
      low > flat * norm(b - a) && dot(normalized(area_vector(a, b, c)), normalized(up)) < same_side;
  return low < least && !bent && std::min(at, 1 - at) > nearest_end && dot(area_vector(c, a, d), up) > 0 &&
         dot(area_vector(d, b, c), up) > 0 && std::min(height(c, a, d), height(d, b, c)) > low &&
         !m.joined(m.apex(h), m.apex(m.opp[h]));
}

/// The triangles around the two of h.
std::vector<int> triangles_around(const EditMesh& m, int h) {
  const int o = m.opp[h];
  std::vector<int> around;
  for (int e : {next(h), prev(h), next(o), prev(o)})
    if (m.opp[e] >= 0) around.push_back(m.opp[e] / 3);
  return around;
}

/// Returns the angle (radians) through which the triangles go around v, counterclockwise if seen against the
/// unit vector `up`: a whole turn where the surface faces up, also where it is folded; none on the rim of a
/// lens or a thin plate.
double angle_around(const EditMesh& m, const Mesh& s, int v, Vec3 up) {
  double angle = 0;
  m.star(v, [&](int h) {
    const Vec3 p = s.points[m.to(h)] - s.points[v], q = s.points[m.apex(h)] - s.points[v];
    angle += std::atan2(dot(cross(p, q), up), dot(p, q) - dot(p, up) * dot(q, up));
  });
  return angle;
}

/// Flips the edge of h in thought, at which the surface lies flat on itself. Returns how far that moves the
/// surface, at most, to `least` or a fiftieth of `tolerance`; infinite if it does not lie so, or still would,
/// or if halving does not tell, or if the edge is of a rim, where flips would leave a notch. The apex of the
/// smaller triangle divides the larger one, from which it is not far. What is left over is the smaller
/// triangle: others may lie where it was. Requires: h is of the smaller triangle.
double unfold(const EditMesh& m, const Mesh& s, int h, double least, double tolerance) {
  const int o = m.opp[h], a = m.from(h), b = m.to(h), c = m.apex(h), d = m.apex(o);
  const Vec3 n = area_vector(s, h / 3), k = area_vector(s, o / 3), up = n + k;
  const auto& p = s.points;
  auto faces_up = [&](int x, int y, int z) { return dot(area_vector(p[x], p[y], p[z]), up) > 0; };
  if (!lie_flat(normalized(n), normalized(k)) || m.joined(c, d) || !faces_up(a, d, c) || !faces_up(b, c, d))
    return infinity;
  const bool of_rim = std::all_of(s.tris[h / 3].begin(), s.tris[h / 3].end(),
                                  [&](int v) { return angle_around(m, s, v, normalized(k)) < least_turn; });
  if (of_rim) return infinity;
  Mesh after;
  auto add = [&](const Tri& t) {
    const int i = (int)after.points.size();
    for (int v : t) after.points.push_back(p[v]);
    after.tris.push_back({i, i + 1, i + 2});
  };
  add({a, d, c}), add({b, c, d});
  for (int t : triangles_around(m, h)) add(s.tris[t]);
  auto nearest = [&](Vec3 q) {
    Bvh::Hit hit{infinity, {-1}};
    for (int t = 0; t < (int)after.tris.size(); ++t)
      if (const double l = norm(closest_point(after, t, q) - q); l < hit.distance) hit = {l, {t}};
    return hit;
  };
  const Piece smaller{{p[a], p[b], p[c]}, {0, 1, 0}, {0, 0, 0}};
  const double apex_moves = norm(closest_point(s, o / 3, p[c]) - p[c]);
  for (double resolution : {least, tolerance / 50}) {
    const Farthest left = farthest(
        smaller, after, [&](int) { return resolution; }, nearest);
    const double found = left.hit.place.face < 0 ? 0 : farther_by * left.hit.distance;
    if (!left.complete && found > tolerance) break;
    if (left.complete) return std::max(found, resolution > least ? resolution : 0) + apex_moves;
  }
  return infinity;
}

/// Per triangle, how far it is from the surface as it was, and what it stands for is from it, at most.
using Drift = std::vector<double>;

/// Returns whether a flip of the edge of h unfolds the surface and keeps it within the tolerance; then the
/// drift is what it is after the flip.
bool may_unfold(const EditMesh& m, const Mesh& s, int h, double least, double tolerance, Drift& drift) {
  const int o = m.opp[h];
  if (m.hard[h] || triangle_area(s, h / 3) > triangle_area(s, o / 3)) return false;
  const double moved = unfold(m, s, h, least, tolerance),
               after = std::max(drift[h / 3], drift[o / 3]) + moved;
  if (!(after <= tolerance)) return false;
  drift[h / 3] = drift[o / 3] = after;
  if (moved > 0)
    for (int t : triangles_around(m, h)) drift[t] = std::max(drift[t], after);
  return true;
}

/// Flags the triangles that may be caps or lie flat on a neighbor, and, as last digits depend on the first
/// corner, some that are not quite as low or flat.
std::vector<char> find_doubtful(const Connectivity& c, double least) {
  const Mesh& s = c.mesh;
  const std::vector<Vec3> normal = face_normals(s);
  std::vector<char> flags(s.tris.size());
#pragma omp parallel for schedule(static)
  for (std::size_t t = 0; t < flags.size(); ++t) {
    const Tri& v = s.tris[t];
    flags[t] = height(s.points[v[0]], s.points[v[1]], s.points[v[2]]) < 2 * least;
    for (std::size_t h = 3 * t; h < 3 * t + 3; ++h)
      flags[t] |= c.opposite[h] >= 0 && turn_back(normal[t], normal[c.opposite[h] / 3]);
  }
  return flags;
}

}  // namespace

Flips flip_caps_and_folds(CutSurface s, const std::vector<int>& line, double tolerance) {
  Surface& surface = s.surface;
  const double least = rounding * diagonal(surface);
  std::vector<char> doubtful = find_doubtful({surface, s.opposite}, least);
  if (std::find(doubtful.begin(), doubtful.end(), 1) == doubtful.end()) return {};
  EditMesh m(Connectivity{surface, s.opposite});
  for (const char* name : {"patch", "part"}) {
    if (!surface.face.has(name)) continue;
    const auto& label = surface.face.get<int>(name);
    for (int h = 0; h < (int)m.opp.size(); ++h)
      if (const int o = m.opp[h]; o >= 0 && label[h / 3] != label[o / 3]) m.hard[h] = 1;
  }
  for (int h = 0; h < (int)m.opp.size(); ++h)
    if (const int o = m.opp[h]; o >= 0 && (line[h] >= 0 || line[o] >= 0)) m.hard[h] = 1;
  Flips flips;
  Drift drift(surface.tris.size(), 0);
  for (int pass = 0, before = -1; pass < most_rows && flips.count != before; ++pass) {
    before = flips.count;
    for (int t = 0; t < (int)m.tris.size(); ++t) {
      if (!doubtful[t]) continue;
      int h = longest_edge(surface, t);
      if (!is_cap(m, surface.points, h, least)) {
        for (h = 3 * t; h < 3 * t + 3 && !may_unfold(m, surface, h, least, tolerance, drift);) ++h;
        if (h == 3 * t + 3) continue;
      }
      const int u = m.opp[h] / 3;
      doubtful[u] = 1;
      for (int near : triangles_around(m, h)) doubtful[near] = 1;
      m.flip(h);
      surface.tris[t] = m.tris[t], surface.tris[u] = m.tris[u];
      for (Column& column : surface.face.columns)
        std::visit([&](auto& values) { values[t] = values[u]; }, column.data);
      ++flips.count;
    }
  }
  flips.moved = *std::max_element(drift.begin(), drift.end());
  s.opposite = std::move(m.opp);
  return flips;
}

}  // namespace meshpipe
