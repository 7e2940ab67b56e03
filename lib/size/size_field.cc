// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/size_field.h"

#include <algorithm>

#include "lib/core/error.h"

namespace meshpipe {

void add_lone_points(SizeField& field) {
  const std::vector<char> used = used_points(field);
  for (int v = 0; v < (int)used.size(); ++v)
    if (!used[v]) field.tris.push_back({v, v, v});
}

double size_near(const SizeField& field, const Bvh& tree, Vec3 p, double gradation) {
  // distances that differ by less than this share of the size are almost equal: sheets that a mesh of that
  // size cannot tell apart
  constexpr double almost_equal = 0.1;
  const Bvh::Hit hit = tree.nearest(p);
  const double nearest = value_at(hit.place, field.size, field.tris);
  double least = nearest;
  const double reach = hit.distance + almost_equal * nearest;
  tree.overlapping({p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}}, [&](int t) {
    const Place place = closest_place(field, t, p);
    const double distance = norm(value_at(place, field.points, field.tris) - p);
    if (distance > reach) return;
    const double h = value_at(place, field.size, field.tris);
    least = std::min(least, h + gradation * std::max(0.0, distance - hit.distance - almost_equal * h));
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
