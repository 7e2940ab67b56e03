// SPDX-License-Identifier: BSD-3-Clause
#include "lib/walk.h"

#include "lib/bvh.h"
#include "lib/topology.h"

namespace meshpipe {

SurfaceWalk::SurfaceWalk(const Mesh& mesh, const std::vector<std::uint8_t>& model)
    : mesh_(mesh),
      neighbour_(opposite_halfedges(mesh.tris, (int)mesh.points.size())),
      normals_(mesh.tris.size()) {
  for (std::size_t t = 0; t < mesh.tris.size(); ++t) {
    const Tri& v = mesh.tris[t];
    normals_[t] = normalized(area_vector(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]));
    for (int i = 0; i < 3 && !model.empty(); ++i)
      if (model[t] >> i & 1) neighbour_[3 * t + i] = -1;
  }
}

Vec3 SurfaceWalk::point(const Place& p) const {
  const Tri& v = mesh_.tris[p.face];
  return p.b0 * mesh_.points[v[0]] + p.b1 * mesh_.points[v[1]] + p.b2 * mesh_.points[v[2]];
}

Place SurfaceWalk::closest(const Place& from, Vec3 target) const {
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
      int g = neighbour_[3 * place.face + (i + 1) % 3];
      if (g >= 0) look(g / 3);
    } else {
      // at a corner: all triangles round it, both ways when a wall is met
      const int i = b[0] > 0 ? 0 : b[1] > 0 ? 1 : 2;
      const int start = 3 * place.face + i;
      int h = start;
      do {
        int g = neighbour_[prev(h)];
        if (g < 0) break;
        look(g / 3);
        h = g;
      } while (h != start);
      if (h != start || neighbour_[prev(start)] < 0)
        for (int g = neighbour_[start]; g >= 0; g = neighbour_[next(g)]) {
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

}  // namespace meshpipe
