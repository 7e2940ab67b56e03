// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/surface_walk.h"

#include "lib/core/bvh.h"
#include "lib/core/normals.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {
constexpr int most_steps = 10000;   ///< from triangle to triangle, or along a line
constexpr double rounding = 1e-12;  ///< of barycentric coordinates: where they were computed, 0 is 1e-17
}  // namespace

double walk_to(Vec3 p, const std::vector<Vec3>& points, const std::vector<Tri>& tris,
               const std::vector<int>& opposite, int& t, double enough) {
  double least = 1e300;
  for (int at = t;;) {
    const auto [a, b, c] = tris[at];
    const Vec3 x = points[a], y = points[b], z = points[c];
    const auto w = closest_on_triangle(p, x, y, z);
    const double d = norm(vector_to(w, x, y, z, p));
    if (!(d < least)) return least;
    least = d, t = at;
    const int i = w[0] <= 0 ? 1 : w[1] <= 0 ? 2 : 0;  // the edge opposite to a corner without weight
    if (d <= enough || w[(i + 2) % 3] > 0 || opposite[3 * at + i] < 0) return least;
    at = opposite[3 * at + i] / 3;
  }
}

SurfaceWalk::SurfaceWalk(const Mesh& mesh, const std::vector<std::uint8_t>& model)
    : mesh_(mesh),
      opposite_(opposite_halfedges(mesh)),
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

Vec3 SurfaceWalk::point(const Place& p) const { return value_at(p, mesh_.points, mesh_.tris); }

Place SurfaceWalk::closest(const Place& from, Vec3 target, bool through_features) const {
  const std::vector<int>& beyond = through_features ? opposite_ : beyond_;
  auto project = [&](int face, double& d2) {
    const Place p = closest_place(mesh_, face, target);
    const Vec3 e = point(p) - target;
    d2 = dot(e, e);
    return p;
  };
  double best = 0;
  Place place = project(from.face, best);
  // each step goes to a triangle strictly closer, so it ends; the bound only guards against rounding
  for (int step = 0; step < most_steps; ++step) {
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
      // at a corner: all triangles around it
      const int i = b[0] > 0 ? 0 : b[1] > 0 ? 1 : 2;
      for_each_spoke(beyond, 3 * place.face + i, [&](int h) {
        if (h / 3 != place.face) look(h / 3);
      });
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
    if (b[(i + 2) % 3] > rounding || beyond_[h] >= 0 || g < 0) continue;
    return place_on_edge(g, b[(i + 1) % 3], b[i]);
  }
  return p;
}

/// The square of the distance of h from the target, nearest at t of it.
double SurfaceWalk::squared_distance(int h, Vec3 target, double& t) const {
  const Vec3 p = mesh_.points[meshpipe::origin(mesh_.tris, h)],
             q = mesh_.points[meshpipe::target(mesh_.tris, h)];
  t = nearest_fraction(target, p, q);
  const Vec3 e = lerp(p, q, t) - target;
  return dot(e, e);
}

/// The next edge of the line of h, at its end or its start; -1 where the line ends.
int SurfaceWalk::next_on_line(int h, bool forward) const {
  const int v = forward ? meshpipe::target(mesh_.tris, h) : meshpipe::origin(mesh_.tris, h);
  if (degree_[v] != 2) return -1;
  int e = forward ? next(h) : prev(h);
  while (beyond_[e] >= 0) e = forward ? next(beyond_[e]) : prev(beyond_[e]);
  return e;
}

/// The edges of lines at corner i of triangle t, from both sides.
std::vector<int> SurfaceWalk::lines_at(int t, int i) const {
  std::vector<int> found;
  auto look = [&](int h) {
    if (beyond_[h] < 0) found.push_back(h);
  };
  for_each_spoke(opposite_, 3 * t + i, [&](int h) {
    look(h);
    look(prev(h));
  });
  return found;
}

Place SurfaceWalk::slide_along(int line, Vec3 target) const {
  double t;
  double best = squared_distance(line, target, t);
  for (int step = 0; step < most_steps && (t <= 0 || t >= 1); ++step) {
    const int e = next_on_line(line, t >= 1);
    double s;
    const double closer = e < 0 ? best : squared_distance(e, target, s);
    if (closer >= best * (1 - 1e-12)) break;
    best = closer, t = s, line = e;
  }
  return place_on_edge(line, 1 - t, t);
}

Place SurfaceWalk::slide(const Place& from, Vec3 target) const {
  const double b[3] = {from.b0, from.b1, from.b2};
  int line = -1;
  for (int i = 0; i < 3; ++i)
    if (b[(i + 2) % 3] <= rounding && beyond_[3 * from.face + i] < 0) line = 3 * from.face + i;
  for (int i = 0; i < 3; ++i) {
    if (b[i] < 1 - rounding) continue;
    // at a vertex, which may be the end of several lines: the one that leaves it towards the target
    double nearest = 1e300, t;
    for (int h : lines_at(from.face, i))
      if (const double d = squared_distance(h, target, t); d < nearest) nearest = d, line = h;
  }
  return line < 0 ? from : slide_along(line, target);
}

Place SurfaceWalk::slide(const Place& from, const Place& to, Vec3 target) const {
  auto corner = [](const Place& p) {
    const double one = 1 - rounding;
    return p.b0 >= one ? 0 : p.b1 >= one ? 1 : p.b2 >= one ? 2 : -1;
  };
  if (corner(from) < 0 || corner(to) < 0) return slide(from, target);
  const int a = mesh_.tris[from.face][corner(from)], b = mesh_.tris[to.face][corner(to)];
  double nearest = 1e300;
  Place best;
  for (int line : lines_at(from.face, corner(from))) {
    const bool forward = meshpipe::origin(mesh_.tris, line) == a;
    auto end = [&](int h) {
      return forward ? meshpipe::target(mesh_.tris, h) : meshpipe::origin(mesh_.tris, h);
    };
    int last = line;
    for (int step = 0; step < most_steps && end(last) != b; ++step) {
      const int e = next_on_line(last, forward);
      if (e < 0) break;
      last = e;
    }
    if (end(last) != b) continue;
    const Place p = slide_along(line, target);
    if (const double d = norm(point(p) - target); d < nearest) nearest = d, best = p;
  }
  return nearest < 1e300 ? best : slide(from, target);
}

}  // namespace meshpipe
