// SPDX-License-Identifier: BSD-3-Clause
// Corners of a surface that are too sharp for good triangles.
#pragma once
#include <vector>

#include "lib/check/quality.h"

namespace meshpipe {

/// The triangles between two successive feature edges (borders and model edges) at a vertex; or all of a
/// vertex without any.
struct Sector {
  int first;      ///< half-edge from the vertex, the first counter-clockwise
  int triangles;  ///< their number
  double angle;   ///< radians over the surface, or between the two edges if that is less
  bool whole;     ///< the vertex has no feature edges

  /// The apex of the isosceles triangle that fills the sector; three of them where it is whole.
  double apex() const { return whole ? angle / 3 : angle; }
};

/// Finds the sectors in which kappa is 0.1 at best, times `scale` in their angle: those of less than 3
/// degrees, or 9 where they are whole.
std::vector<Sector> needle_sectors(const Connectivity& surface, double scale = 1);

/// Flags the triangles with kappa up to 0.1 that corners of the reference force to be so: in a needle sector
/// of the vertex that stands for the corner, and with at least half the kappa of the isosceles triangle of
/// its angle. A strip beyond the corner is not forced: two triangles across it may be as small as it is
/// narrow.
std::vector<char> forced_needles(const Connectivity& result, const std::vector<float>& kappas,
                                 const Connectivity& reference);

/// Returns the smallest kappa of the triangles two rings away from every sharp feature corner (feature edges
/// meet at less than 40 degrees over the surface); 1 if there are none. `worst` becomes the triangle, or -1.
double kappa_off_corners(const Connectivity& surface, const Quality& quality, int& worst);

}  // namespace meshpipe
