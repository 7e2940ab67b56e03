// SPDX-License-Identifier: BSD-3-Clause
// What lies between the feature edges at a vertex.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns whether half-edge h is on a border or marked as a model edge in its own triangle.
inline bool is_feature(const Connectivity& s, int h) { return s.is_border(h) || s.is_model(h); }

/// Returns the angle of the triangle of half-edge h at its origin.
inline double corner_angle(const Connectivity& s, int h) {
  const Vec3 p = s.point(s.from(h));
  return angle(s.point(s.to(h)) - p, s.point(s.apex(h)) - p);
}

/// The triangles between successive feature edges (borders, model edges) at a vertex; all if it has none.
struct Sector {
  int first;      ///< half-edge from the vertex, the first counter-clockwise
  int triangles;  ///< their number
  double angle;   ///< radians over the surface, or between the two edges if that is less
  bool whole;     ///< the vertex has no feature edges

  /// Returns the apex angle of an isosceles triangle that fills the sector; of each of three if it is whole.
  double apex() const { return whole ? angle / 3 : angle; }
};

/// Returns the sectors with an angle below 3 degrees times `scale`, below 9 times `scale` where they are
/// whole: with 1, those that no triangle with kappa above 0.1 fills.
std::vector<Sector> needle_sectors(const Connectivity& surface, double scale = 1);

}  // namespace meshpipe
