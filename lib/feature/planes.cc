// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/planes.h"

#include <algorithm>
#include <cmath>

#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

constexpr int many = 8;             ///< triangles of a plane face that chance does not make
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
std::vector<char> find_steps(const Connectivity& c, const std::vector<int>& face,
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

std::vector<PlaneShares> plane_shares(const Connectivity& c, const Bends& bends) {
  const std::vector<int> face = plane_faces(c, bends.angle);
  const std::vector<char> is_step = find_steps(c, face, bends.strong);
  std::vector<int> triangles(c.n_tris(), 0);
  for (int f : face) ++triangles[f];
  std::vector<PlaneShares> shares(bends.components);
  std::vector<double> area(bends.components, 0), crease(bends.components, 0);
  for (int t = 0; t < c.n_tris(); ++t) {
    const int i = bends.component[t];
    const double own = 0.5 * norm(c.area_vector(t));
    area[i] += own;
    if (triangles[face[t]] > 1) shares[i].several += own;
    if (triangles[face[t]] >= many) shares[i].many += own;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (bends.strong[h]) crease[i] += c.length(h);
      if (is_step[h]) shares[i].steps += c.length(h);
    }
  }
  for (int i = 0; i < bends.components; ++i)
    shares[i].several /= area[i], shares[i].many /= area[i], shares[i].steps /= crease[i];
  return shares;
}

}  // namespace meshpipe
