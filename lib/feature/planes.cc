// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/planes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

constexpr double flat_angle = std::numbers::pi / 180;  ///< across diagonals, with rounded coordinates
constexpr double plane_share = 0.8;                    ///< of the area, in plane faces of several triangles
/// Of the creases, by length. Steps of segmented images have 0.96 or more, machined parts up to 0.8: a boss
/// next to a groove is a step too.
constexpr double step_share = 0.85;
constexpr double directions = 1.6;  ///< normals are rounded after this factor: to about a hundred directions

/// The face of each triangle: triangles connected across edges that are almost flat.
std::vector<int> plane_faces(const Connectivity& c, const std::vector<double>& angle) {
  UnionFind face(c.n_tris());
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (c.opposite[h] > h && angle[h] < flat_angle) face.join(h / 3, c.opposite[h] / 3);
  std::vector<int> number(c.n_tris());
  for (int t = 0; t < c.n_tris(); ++t) number[t] = face.find(t);
  return number;
}

/// Flags the creases at steps.
std::vector<char> steps(const Connectivity& c, const std::vector<int>& face,
                        const std::vector<char>& strong) {
  struct Side {
    int face, direction, half_edge;  ///< the direction of the face beyond
    bool up;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  for (int h = 0; h < c.n_half_edges(); ++h) {
    const int o = c.opposite[h];
    if (o < 0 || !strong[h]) continue;
    const Vec3 d = directions * normalized(c.area_vector(o / 3));
    const int direction = 25 * (int)std::lround(d.x) + 5 * (int)std::lround(d.y) + (int)std::lround(d.z);
    const Vec3 beyond = c.point(c.from(prev(o))) - c.point(c.from(h));
    sides.push_back({face[h / 3], direction, h, dot(c.area_vector(h / 3), beyond) > 0});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<char> is_step(c.n_half_edges(), 0);
  for (std::size_t i = 0, end; i < sides.size(); i = end) {
    bool up = false, down = false;
    for (end = i;
         end < sides.size() && sides[end].face == sides[i].face && sides[end].direction == sides[i].direction;
         ++end)
      (sides[end].up ? up : down) = true;
    for (std::size_t j = i; up && down && j < end; ++j)
      is_step[sides[j].half_edge] = is_step[c.opposite[sides[j].half_edge]] = 1;
  }
  return is_step;
}

}  // namespace

std::vector<char> made_of_planes(const Connectivity& c, const Bends& bends) {
  const std::vector<int> face = plane_faces(c, bends.angle);
  const std::vector<char> is_step = steps(c, face, bends.strong);
  std::vector<int> triangles(c.n_tris(), 0);
  for (int f : face) ++triangles[f];
  struct Sums {
    double area = 0, plane = 0, crease = 0, step = 0;
  };
  std::vector<Sums> sums(bends.components);
  for (int t = 0; t < c.n_tris(); ++t) {
    Sums& sum = sums[bends.component[t]];
    const double area = 0.5 * norm(c.area_vector(t));
    sum.area += area;
    if (triangles[face[t]] > 1) sum.plane += area;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (bends.strong[h]) sum.crease += c.length(h);
      if (is_step[h]) sum.step += c.length(h);
    }
  }
  std::vector<char> planes(bends.components);
  for (int i = 0; i < bends.components; ++i)
    planes[i] = sums[i].plane >= plane_share * sums[i].area && sums[i].step < step_share * sums[i].crease;
  return planes;
}

}  // namespace meshpipe
