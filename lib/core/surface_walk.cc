// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/surface_walk.h"

#include <algorithm>

#include "lib/core/bvh.h"
#include "lib/core/normals.h"
#include "lib/core/topology.h"

namespace meshpipe {

double walk_to(Vec3 p, const std::vector<Vec3>& points, const std::vector<Tri>& tris,
               const std::vector<int>& opposite, int& t, double enough) {
  double least = 1e300;
  for (int at = t;;) {
    const auto [a, b, c] = tris[at];
    const Vec3 x = points[a], y = points[b], z = points[c];
    const auto w = closest_on_triangle(p, x, y, z);
    const double d = norm(w[0] * x + w[1] * y + w[2] * z - p);
    if (!(d < least)) return least;
    least = d, t = at;
    const int i = w[0] <= 0 ? 1 : w[1] <= 0 ? 2 : 0;  // the edge opposite to a corner without weight
    if (d <= enough || w[(i + 2) % 3] > 0 || opposite[3 * at + i] < 0) return least;
    at = opposite[3 * at + i] / 3;
  }
}

SurfaceWalk::SurfaceWalk(const Mesh& mesh, const std::vector<std::uint8_t>& model)
    : mesh_(mesh),
      opposite_(opposite_halfedges(mesh.tris, (int)mesh.points.size())),
      beyond_(opposite_),
      normals_(face_normals(mesh)),
      degree_(mesh.points.size()) {
  const Connectivity c{mesh, opposite_, model};
  for (int h = 0; h < c.n_half_edges(); ++h) {
    if (!c.is_border(h) && !c.is_model(h)) continue;
    beyond_[h] = -1;
    if (opposite_[h] >= 0) beyond_[opposite_[h]] = -1;
    if (opposite_[h] > h) continue;  // count an edge once
    for (int v : {c.from(h), c.to(h)})
      if (degree_[v] < 3) ++degree_[v];
  }
}

Vec3 SurfaceWalk::point(const Place& p) const {
  const Tri& v = mesh_.tris[p.face];
  return p.b0 * mesh_.points[v[0]] + p.b1 * mesh_.points[v[1]] + p.b2 * mesh_.points[v[2]];
}

Place SurfaceWalk::closest(const Place& from, Vec3 target, bool through_features) const {
  const std::vector<int>& beyond = through_features ? opposite_ : beyond_;
  auto project = [&](int face, double& d2) {
    const Tri& v = mesh_.tris[face];
    auto b = closest_on_triangle(target, mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]);
    Place p{face, b[0], b[1], b[2]};
    Vec3 e = point(p) - target;
    d2 = dot(e, e);
    return p;
  };
  double best = 0;
  Place place = project(from.face, best);
  // each step goes to a triangle strictly closer, so it ends; the bound only guards against rounding
  for (int step = 0; step < 10000; ++step) {
    const double b[3] = {place.b0, place.b1, place.b2};
    const int zeros = (b[0] <= 0) + (b[1] <= 0) + (b[2] <= 0);
    if (zeros == 0) break;
    Place better = place;
    double closer = best;
    auto look = [&](int face) {
      double d2;
      Place p = project(face, d2);
      if (d2 < closer) {
        closer = d2;
        better = p;
      }
    };
    if (zeros == 1) {
      const int i = b[0] <= 0 ? 0 : b[1] <= 0 ? 1 : 2;  // on the edge opposite to corner i
      int g = beyond[3 * place.face + (i + 1) % 3];
      if (g >= 0) look(g / 3);
    } else {
      // at a corner: all triangles around it, both ways where the fan is open
      const int i = b[0] > 0 ? 0 : b[1] > 0 ? 1 : 2;
      const int start = 3 * place.face + i;
      int h = start;
      do {
        int g = beyond[prev(h)];
        if (g < 0) break;
        look(g / 3);
        h = g;
      } while (h != start);
      if (h != start || beyond[prev(start)] < 0)
        for (int g = beyond[start]; g >= 0; g = beyond[next(g)]) {
          look(g / 3);
          if (next(g) == start) break;
        }
    }
    if (closer >= best * (1 - 1e-12)) break;
    best = closer;
    place = better;
  }
  return place;
}

Place SurfaceWalk::across(const Place& p) const {
  const double b[3] = {p.b0, p.b1, p.b2};
  for (int i = 0; i < 3; ++i) {
    const int h = 3 * p.face + i, g = opposite_[h];
    if (b[(i + 2) % 3] > 0 || beyond_[h] >= 0 || g < 0) continue;
    Place q{g / 3, 0, 0, 0};
    double* c[3] = {&q.b0, &q.b1, &q.b2};
    *c[g % 3] = b[(i + 1) % 3];
    *c[(g + 1) % 3] = b[i];
    return q;
  }
  return p;
}

Place SurfaceWalk::slide(const Place& from, Vec3 target) const {
  const double b[3] = {from.b0, from.b1, from.b2};
  auto closest_on = [&](int h, double& t) {
    const Vec3 p = mesh_.points[meshpipe::origin(mesh_.tris, h)],
               q = mesh_.points[meshpipe::target(mesh_.tris, h)];
    const double l2 = dot(q - p, q - p);
    t = l2 > 0 ? std::clamp(dot(target - p, q - p) / l2, 0.0, 1.0) : 0;
    const Vec3 e = lerp(p, q, t) - target;
    return dot(e, e);
  };
  int line = -1;
  double t;
  for (int i = 0; i < 3; ++i)
    if (b[(i + 2) % 3] <= 0 && beyond_[3 * from.face + i] < 0) line = 3 * from.face + i;
  for (int i = 0; i < 3; ++i) {
    if (b[i] < 1) continue;
    // at a vertex, which may be the end of several lines: the one that leaves it towards the target
    double nearest = 1e300;
    auto look = [&](int h) {
      if (beyond_[h] >= 0) return;
      if (const double d = closest_on(h, t); d < nearest) nearest = d, line = h;
    };
    const int start = 3 * from.face + i;
    int h = start;
    do {
      look(h);
      look(prev(h));
      h = opposite_[prev(h)];
    } while (h >= 0 && h != start);
    for (int e = start; h < 0 && opposite_[e] >= 0;) {
      e = next(opposite_[e]);
      look(e);
      look(prev(e));
    }
  }
  if (line < 0) return from;

  double best = closest_on(line, t);
  for (int step = 0; step < 10000 && (t <= 0 || t >= 1); ++step) {
    const bool forward = t >= 1;
    const int v = forward ? meshpipe::target(mesh_.tris, line) : meshpipe::origin(mesh_.tris, line);
    if (degree_[v] != 2) break;
    int e = forward ? next(line) : prev(line);
    while (beyond_[e] >= 0) e = forward ? next(beyond_[e]) : prev(beyond_[e]);
    double s;
    const double closer = closest_on(e, s);
    if (closer >= best * (1 - 1e-12)) break;
    best = closer, t = s, line = e;
  }
  Place p{line / 3, 0, 0, 0};
  double* c[3] = {&p.b0, &p.b1, &p.b2};
  *c[line % 3] = 1 - t;
  *c[(line + 1) % 3] = t;
  return p;
}

}  // namespace meshpipe
