// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/sectors.h"

#include <algorithm>

namespace meshpipe {
namespace {

/// kappa of an isosceles triangle is 0.1 at an apex of 3 degrees; a vertex without feature edges needs at
/// least three triangles.
constexpr double needle_angle = 3 * degree;
constexpr double widest = 40 * degree;  ///< over a folded sector, whose edges may be nearer to each other

/// Angle at their origin between half-edge h and the third side of the triangle of half-edge g.
double angle_between(const Connectivity& s, int h, int g) {
  const Vec3 p = s.point(s.from(h));
  return angle(s.point(s.to(h)) - p, s.point(s.apex(g)) - p);
}

}  // namespace

std::vector<Sector> needle_sectors(const Connectivity& surface, double scale) {
  std::vector<Sector> sectors;
  for (int h = 0; h < surface.n_half_edges(); ++h) {
    const bool bounded = is_feature(surface, h);
    const double limit = scale * (bounded ? needle_angle : 3 * needle_angle);
    Sector s{h, 1, corner_angle(surface, h), !bounded};
    int first = h, last = h;  // the last half-edge from the vertex
    bool closed = false;
    for (; s.angle < (bounded ? widest : limit) && !is_feature(surface, prev(last)) && !closed;) {
      last = surface.opposite[prev(last)];
      first = std::min(first, last);
      closed = last == h;
      if (!closed) s.angle += corner_angle(surface, last), ++s.triangles;
    }
    // between the edges of a folded sector: a result without the fold has this angle there
    if (bounded && is_feature(surface, prev(last)))
      s.angle = std::min(s.angle, angle_between(surface, h, last));
    // a sector is found from its first edge, a whole one from its smallest half-edge
    if (s.angle < limit && (bounded || (closed && first == h))) sectors.push_back(s);
  }
  return sectors;
}

}  // namespace meshpipe
