// SPDX-License-Identifier: BSD-3-Clause
// Chords: edges between two vertices of one rim that lie on the plane triangles across the rim, as an edge of
// a tube does that runs straight over the tube's cap. The exact predicates of lib/core/intersect.h see a
// contact there or none, as the rounding of the vertices has it; volume meshers refuse both.
#pragma once
#include <algorithm>
#include <utility>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns whether the segment from p to q leaves p along triangle p, y, z: between the sides py and pz, at
/// an angle to the triangle's plane whose sine is at most `sine`.
inline bool leaves_along(Vec3 p, Vec3 q, Vec3 y, Vec3 z, double sine) {
  const Vec3 e = q - p, n = cross(y - p, z - p);
  return std::abs(dot(e, n)) <= sine * norm(e) * norm(n) && dot(cross(y - p, e), n) >= 0 &&
         dot(cross(e, z - p), n) >= 0 && dot(n, n) > 0;
}

/// Returns a triangle along which the segment from p, the origin of half-edge `spoke`, to q leaves
/// (leaves_along), of those at p that a hard edge separates from the spoke's triangle; -1 if there is none.
/// `opposite(h)`: the opposite half-edge, -1 at borders; `hard(h)`: whether h is on a model edge or border.
template <class Opposite, class Hard>
int triangle_along(const std::vector<Tri>& tris, const std::vector<Vec3>& points, Opposite opposite,
                   Hard hard, int spoke, Vec3 q, double sine) {
  const Vec3 p = points[origin(tris, spoke)];
  int first = spoke;  // the first spoke of its sector, clockwise
  while (!hard(first))
    if ((first = next(opposite(first))) == spoke) return -1;
  bool outside = false;
  int h = first;
  auto along = [&] {
    return outside && leaves_along(p, q, points[target(tris, h)], points[origin(tris, prev(h))], sine);
  };
  do {
    if (along()) return h / 3;
    outside = outside || hard(prev(h));
    h = opposite(prev(h));
  } while (h >= 0 && h != first);
  outside = true;
  for (h = h < 0 ? opposite(first) : -1; h >= 0; h = opposite(h)) {
    h = next(h);
    if (along()) return h / 3;
  }
  return -1;
}

/// Returns the pairs of triangles of which one has a chord for an edge and the other lies along it, as far as
/// rounding leaves it on the plane; sorted. Rows of `tris` may be dead: their first vertex is negative.
template <class Opposite, class Hard>
std::vector<std::pair<int, int>> chord_pairs(const std::vector<Tri>& tris, const std::vector<Vec3>& points,
                                             Opposite opposite, Hard hard) {
  constexpr double rounding = 1e-6;  // sine
  std::vector<char> on_line(points.size(), 0);
  std::vector<std::pair<int, int>> pairs;
  const int n = 3 * (int)tris.size();
  auto dead = [&](int h) { return tris[h / 3][0] < 0; };
  for (int h = 0; h < n; ++h)
    if (!dead(h) && hard(h)) on_line[origin(tris, h)] = on_line[target(tris, h)] = 1;
  for (int h = 0; h < n; ++h) {
    if (dead(h) || hard(h) || !on_line[origin(tris, h)] || !on_line[target(tris, h)]) continue;
    const int t = triangle_along(tris, points, opposite, hard, h, points[target(tris, h)], rounding);
    if (t >= 0) pairs.push_back({std::min(h / 3, t), std::max(h / 3, t)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Returns the same of a surface, where borders and model edges are hard.
inline std::vector<std::pair<int, int>> chord_pairs(const Connectivity& c) {
  return chord_pairs(
      c.mesh.tris, c.mesh.points, [&](int h) { return c.opposite[h]; },
      [&](int h) { return c.is_border(h) || c.is_model(h); });
}

}  // namespace meshpipe
