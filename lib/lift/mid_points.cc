// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <tuple>

#include "lib/core/connectivity.h"
#include "lib/core/surface_walk.h"
#include "lib/core/topology.h"
#include "lib/lift/lift.h"

namespace meshpipe {
namespace {

/// The reference with its feature edges (borders and model edges) by the vertices they meet at.
class Ground {
 public:
  explicit Ground(const Surface& reference) : mesh_(reference), walk(reference, model_of(reference)) {
    const std::vector<int> opposite = opposite_halfedges(reference);
    const Connectivity mesh{reference, opposite, model_of(reference)};
    for (int h = 0; h < mesh.n_half_edges(); ++h)
      if (mesh.is_border(h) || mesh.is_model(h))
        for (int v : {mesh.from(h), mesh.to(h)}) features_.push_back({v, h});
    std::sort(features_.begin(), features_.end());
  }

  /// Returns the nearest place to p that is reached from one of these without crossing feature edges.
  Place closest(const std::vector<Place>& from, Vec3 p) const {
    Place best;
    double least = 1e300;
    for (const Place& start : from)
      for (const Place& side : {start, walk.across(start)})
        keep_closer(walk.closest(side, p), p, best, least);
    return best;
  }

  /// Returns the nearest place to p on the feature edges through two places.
  Place slide(const Place& a, const Place& b, Vec3 p) const {
    Place best;
    double least = 1e300;
    for (const Place& start : {a, b}) {
      keep_closer(walk.slide(start, p), p, best, least);
      const double at[3] = {start.b0, start.b1, start.b2};
      for (int i = 0; i < 3; ++i) {
        if (at[i] < 1) continue;
        const int v = mesh_.tris[start.face][i];
        for (auto w = std::lower_bound(features_.begin(), features_.end(), std::pair(v, 0));
             w != features_.end() && w->first == v; ++w) {
          Place middle{w->second / 3, 0.5, 0.5, 0.5};
          (w->second % 3 == 0 ? middle.b2 : w->second % 3 == 1 ? middle.b0 : middle.b1) = 0;
          keep_closer(walk.slide(middle, p), p, best, least);
        }
      }
    }
    return best;
  }

 private:
  void keep_closer(const Place& place, Vec3 p, Place& best, double& least) const {
    const double d = norm(walk.point(place) - p);
    if (d < least) best = place, least = d;
  }

  const Mesh& mesh_;
  std::vector<std::pair<int, int>> features_;  ///< vertex and half-edge

 public:
  SurfaceWalk walk;
};

/// Does the triangle of second order with these corners and edge midpoints keep its corners' orientation at
/// all six nodes?
bool is_sound(const Vec3 (&x)[3], const Vec3 (&m)[3]) {
  const Vec3 n = area_vector(x[0], x[1], x[2]);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    // derivatives along edges i, j and k, i at corner i, and at the middle of edge i, j
    const Vec3 u = -3 * x[i] - x[j] + 4 * m[i], v = -3 * x[i] - x[k] + 4 * m[k];
    if (!(dot(cross(u, v), n) > 0)) return false;
    const Vec3 along = x[j] - x[i], up = -1 * x[i] - x[k] - 2 * m[i] + 2 * m[j] + 2 * m[k];
    if (!(dot(cross(along, up), n) > 0)) return false;
  }
  return true;
}

}  // namespace

MidPoints mid_points(const LiftedMesh& mesh, const Surface& reference, const CurvedSurface* surface) {
  const Ground ground(reference);
  const std::vector<int> opposite = opposite_halfedges(mesh);
  const int n = (int)opposite.size();
  std::vector<Vec3> middle(n);
  auto chord = [&](int h) {
    return lerp(mesh.points[origin(mesh.tris, h)], mesh.points[target(mesh.tris, h)], 0.5);
  };
  std::vector<Place> from;
  for (int h = 0; h < n; ++h) {
    const int o = opposite[h], a = origin(mesh.tris, h), b = target(mesh.tris, h);
    if (o > h) continue;
    const Place &pa = mesh.place[a], &pb = mesh.place[b];
    const Vec3 p = lerp(ground.walk.point(pa), ground.walk.point(pb), 0.5);
    Place place;
    if (o < 0 || (mesh.model[h / 3] >> (h % 3) & 1)) {
      place = ground.slide(pa, pb, p);
    } else {
      // from vertices inside, if there are any: those on lines may have their place beyond them
      from.clear();
      for (int v : {a, b, origin(mesh.tris, prev(h)), origin(mesh.tris, prev(o))})
        if (mesh.kind[v] == 0) from.push_back(mesh.place[v]);
      if (from.size() > 2) from.resize(2);
      if (mesh.kind[a] != 0 && mesh.kind[b] != 0) from.push_back(pa), from.push_back(pb);
      place = ground.closest(from, p);
    }
    middle[h] = surface ? surface->point(place) : ground.walk.point(place);
    if (o >= 0) middle[o] = middle[h];
  }

  MidPoints out;
  std::vector<char> straight(n, 0);
  for (bool straightened = true; straightened;) {
    straightened = false;
    for (int t = 0; t < n / 3; ++t) {
      const Tri& v = mesh.tris[t];
      if (is_sound({mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]},
                   {middle[3 * t], middle[3 * t + 1], middle[3 * t + 2]}))
        continue;
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        if (straight[h]) continue;
        const int o = opposite[h];
        straight[h] = 1, middle[h] = chord(h);
        if (o >= 0) straight[o] = 1, middle[o] = middle[h];
        ++out.straight;
        straightened = true;
      }
    }
  }
  for (int h = 0; h < n; ++h) {
    const int a = origin(mesh.tris, h), b = target(mesh.tris, h);
    if (opposite[h] < h) out.points.push_back({std::min(a, b), std::max(a, b), middle[h]});
  }
  std::sort(out.points.begin(), out.points.end(),
            [](const MidPoint& x, const MidPoint& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
  return out;
}

}  // namespace meshpipe
