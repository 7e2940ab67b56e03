// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/size_field.h"

#include <algorithm>

#include "lib/core/error.h"

namespace meshpipe {

void add_lone_points(SizeField& field) {
  const std::vector<char> used = used_points(field);
  for (int v = 0; v < static_cast<int>(used.size()); ++v)
    if (!used[v]) field.tris.push_back({v, v, v});
}

double size_near(const SizeField& field, const Bvh& tree, Vec3 p) {
  // distances that differ by less than this share of the size are almost equal: sheets that a mesh of that
  // size cannot tell apart
  constexpr double almost_equal = 0.1;
  auto size_at = [&](int t, double b0, double b1, double b2) {
    const Tri& v = field.tris[t];
    return b0 * field.size[v[0]] + b1 * field.size[v[1]] + b2 * field.size[v[2]];
  };
  const Bvh::Hit hit = tree.nearest(p);
  const double nearest = size_at(hit.place.face, hit.place.b0, hit.place.b1, hit.place.b2);
  double least = nearest;
  const double reach = hit.distance + almost_equal * nearest;
  tree.overlapping({p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}}, [&](int t) {
    const Vec3 a = field.points[field.tris[t][0]], b = field.points[field.tris[t][1]],
               c = field.points[field.tris[t][2]];
    const auto w = closest_on_triangle(p, a, b, c);
    if (norm(w[0] * a + w[1] * b + w[2] * c - p) <= reach)
      least = std::min(least, size_at(t, w[0], w[1], w[2]));
  });
  return least;
}

void expect_data(const Surface& surface, const std::string& name) {
  if (surface.vertex.has(name)) return;
  std::string known;
  for (const Column& c : surface.vertex.columns) known += (known.empty() ? "" : ", ") + c.name;
  throw NotAdmissible("no vertex data '" + name + "'; there is " + (known.empty() ? "none" : known));
}

}  // namespace meshpipe
