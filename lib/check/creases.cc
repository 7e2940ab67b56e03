// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lib/check/check.h"
#include "lib/core/lists.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

constexpr double sharp = 0.5;  // cosine, 60 degrees: rounder bends are followed by chords across them

/// The model edges at which the surface bends sharply, as triangles without area, and the components of the
/// surface: of each of its triangles, and of each crease.
struct Creases {
  Mesh edges;
  std::vector<int> component_of_triangle, component;
};

Creases sharp_creases(const Surface& surface) {
  Creases creases{{surface.points, {}}, {}, {}};
  if (!surface.face.has("model")) return creases;
  const auto& model = surface.face.get<std::uint8_t>("model");
  if (std::count(model.begin(), model.end(), 0) == (long)model.size()) return creases;
  const std::vector<int> opposite = opposite_halfedges(surface);
  components(opposite, creases.component_of_triangle);
  auto normal = [&](int h) { return normalized(area_vector(surface, h / 3)); };
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] > h && (model[h / 3] >> h % 3 & 1) && dot(normal(h), normal(opposite[h])) < sharp) {
      const int to = target(surface.tris, h);
      creases.edges.tris.push_back({origin(surface.tris, h), to, to});
      creases.component.push_back(creases.component_of_triangle[h / 3]);
    }
  return creases;
}

}  // namespace

std::vector<int> find_cut_creases(const Connectivity& result, const Surface& reference) {
  constexpr double near = 0.6, on = 0.15;  // of the edge
  const Creases creases = sharp_creases(reference);
  std::vector<int> cut;
  if (creases.edges.tris.empty()) return cut;
  const Bvh search(creases.edges), tree(reference);
  const Mesh& mesh = result.mesh;
  std::vector<int> near_c;  // components
  for (int h = 0; h < result.n_half_edges(); ++h) {
    if (result.opposite[h] < h) continue;
    const Vec3 a = mesh.points[origin(mesh.tris, h)], b = mesh.points[target(mesh.tris, h)];
    const Vec3 c = mesh.points[result.apex(h)], d = mesh.points[result.apex(result.opposite[h])];
    const Vec3 middle = lerp(a, b, 0.5);
    const double length = norm(b - a), reach = on * length;
    const Vec3 margin{reach, reach, reach};
    near_c.clear();
    search.overlapping({c - margin, c + margin}, [&](int e) { near_c.push_back(creases.component[e]); });
    sort_unique(near_c);
    // creases of other components may pass by
    const bool cuts = std::any_of(near_c.begin(), near_c.end(), [&](int component) {
      auto meets = [&](Vec3 p, double within) {
        return search.nearest_of(creases.component, component, p, within, 0).place.face >= 0;
      };
      if (!meets(middle, near * length) || meets(a, reach) || meets(b, reach) || !meets(c, reach) ||
          !meets(d, reach) || !meets(lerp(c, d, 0.5), reach))
        return false;
      auto nearest = [&](Vec3 p) {
        return tree.nearest_of(creases.component_of_triangle, component, p, 1e300, 0);
      };
      auto normal = [&](const Bvh::Hit& hit) { return normalized(area_vector(reference, hit.place.face)); };
      const Bvh::Hit at_a = nearest(a), at_b = nearest(b);
      return at_a.distance < reach && at_b.distance < reach && dot(normal(at_a), normal(at_b)) < sharp &&
             nearest(middle).distance > reach;
    });
    if (cuts) cut.push_back(h);
  }
  return cut;
}

}  // namespace meshpipe
