// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lib/check/check.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

constexpr double sharp = 0.5;  // cosine, 60 degrees: rounder bends are followed by chords across them

/// The model edges at which the surface bends sharply, as triangles without area.
Mesh sharp_creases(const Surface& surface) {
  Mesh creases{surface.points, {}};
  if (!surface.face.has("model")) return creases;
  const auto& model = surface.face.get<std::uint8_t>("model");
  if (std::count(model.begin(), model.end(), 0) == (long)model.size()) return creases;
  const std::vector<int> opposite = opposite_halfedges(surface);
  auto normal = [&](int h) { return normalized(area_vector(surface, h / 3)); };
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] > h && (model[h / 3] >> h % 3 & 1) && dot(normal(h), normal(opposite[h])) < sharp)
      creases.tris.push_back({origin(surface.tris, h), target(surface.tris, h), target(surface.tris, h)});
  return creases;
}

}  // namespace

std::vector<int> find_cut_creases(const Connectivity& result, const Surface& reference) {
  constexpr double near = 0.6, on = 0.15;  // of the edge
  const Mesh creases = sharp_creases(reference);
  std::vector<int> cut;
  if (creases.tris.empty()) return cut;
  const Bvh search(creases), tree(reference);
  auto meets = [&](Vec3 p, double reach) { return search.nearest_within(p, reach, 0).place.face >= 0; };
  const Mesh& mesh = result.mesh;
  for (int h = 0; h < result.n_half_edges(); ++h) {
    if (result.opposite[h] < h) continue;
    const Vec3 a = mesh.points[origin(mesh.tris, h)], b = mesh.points[target(mesh.tris, h)];
    const Vec3 middle = lerp(a, b, 0.5);
    const double length = norm(b - a);
    if (!meets(middle, near * length) || meets(a, on * length) || meets(b, on * length)) continue;
    const Vec3 c = mesh.points[result.apex(h)], d = mesh.points[result.apex(result.opposite[h])];
    if (!meets(c, on * length) || !meets(d, on * length) || !meets(lerp(c, d, 0.5), on * length)) continue;
    auto normal = [&](Vec3 p) { return normalized(area_vector(reference, tree.nearest(p).place.face)); };
    if (dot(normal(a), normal(b)) < sharp && tree.nearest(middle).distance > on * length) cut.push_back(h);
  }
  return cut;
}

}  // namespace meshpipe
