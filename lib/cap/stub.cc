// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "lib/cap/steps.h"
#include "lib/core/number.h"

namespace meshpipe {
namespace {

/// Directions that are tried, one after another: along the normal of the rim, then around it, farther away.
constexpr int per_circle = 8, most_tilts = 1 + 3 * per_circle;
constexpr double tilt_of_circle = 15 * std::numbers::pi / 180;

Vec3 tilted(Vec3 normal, int k) {
  if (k == 0) return normal;
  const double turn = 2 * std::numbers::pi * k / per_circle;
  const double tilt = tilt_of_circle * (1 + (k - 1) / per_circle);
  const PlaneView flat({{}, normal});
  return std::cos(tilt) * normal + std::sin(tilt) * (std::cos(turn) * flat.right + std::sin(turn) * flat.up);
}

}  // namespace

std::vector<std::string> raise_ends(Mesh& mesh, std::vector<End>& ends, const std::vector<char>& flagged,
                                    Growth& growth, std::vector<int>& owner) {
  const int n = (int)ends.size();
  const std::vector<End> before = ends;
  const std::size_t points = mesh.points.size(), triangles = mesh.tris.size();
  std::vector<std::string> obstacle(n);
  std::vector<int> tries(n, 0);
  for (bool again = true; again;) {
    mesh.points.resize(points);
    mesh.tris.resize(triangles);
    owner.resize(triangles);
    growth.vertex_like.clear();
    for (int i = 0; i < n; ++i) {
      ends[i] = before[i];
      for (; flagged[i] && tries[i] < most_tilts; ++tries[i]) {
        ends[i].normal = tilted(before[i].normal, tries[i]);
        const std::string crossing = crossing_at(mesh, ends[i]);
        if (crossing.empty()) break;
        if (obstacle[i].empty()) obstacle[i] = crossing;
      }
      if (flagged[i] && tries[i] < most_tilts) raise_end(mesh, ends[i], growth);
      owner.resize(mesh.tris.size(), i);
    }
    std::vector<char> meets(n, 0);
    for (const Collision& c : collisions_of_new(mesh, owner)) {
      const int i = owner[c.triangle];
      if (obstacle[i].empty()) obstacle[i] = "a stub there would meet the surface near " + shown(c.place);
      meets[i] = 1;
    }
    again = false;
    for (int i = 0; i < n; ++i) tries[i] += meets[i], again |= meets[i] > 0;
  }
  for (int i = 0; i < n; ++i)
    if (tries[i] < most_tilts) obstacle[i].clear();
  return obstacle;
}

}  // namespace meshpipe
