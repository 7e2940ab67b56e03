// SPDX-License-Identifier: BSD-3-Clause
// The line and the ray through a point along x, and triangles.
#pragma once
#include <utility>

#include "lib/core/predicates.h"

namespace meshpipe {

/// Returns whether the line through p along x, both ways, passes through triangle abc. Symbolic perturbation
/// (p moves a little in z, less in y) counts once where triangles share an edge or a vertex.
inline bool line_passes(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3* corner[] = {&a, &b, &c};
  bool inside = false;
  for (int i = 0; i < 3; ++i) {
    const Vec3 *low = corner[i], *high = corner[(i + 1) % 3];
    if ((low->z > p.z) == (high->z > p.z)) continue;
    if (low->z > high->z) std::swap(low, high);
    inside ^= orient2d({low->y, low->z}, {high->y, high->z}, {p.y, p.z}) > 0;  // the edge is at larger y
  }
  return inside;
}

/// Returns how the ray from p in direction +x crosses triangle abc: +1 if along its normal (it leaves), -1 if
/// against it (it enters), 0 if not, or if p lies on the triangle.
inline int ray_crossing(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  if (!line_passes(p, a, b, c)) return 0;
  const int below = orient3d(a, b, c, p), turn = orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z});
  return below * turn > 0 ? turn : 0;
}

}  // namespace meshpipe
