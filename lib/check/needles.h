// SPDX-License-Identifier: BSD-3-Clause
// Corners of a surface that are too sharp for good triangles.
#pragma once
#include <vector>

#include "lib/check/quality.h"

namespace meshpipe {

/// A corner so sharp that kappa of a triangle there is 0.1 at best.
struct NeedleCorner {
  Vec3 point;
  double angle;  ///< radians between the feature edges; without any, a third of the whole angle
};

/// Finds the vertices where feature edges (borders and model edges) meet at less than 3 degrees over the
/// surface, or that have none and less than 9 degrees in all.
std::vector<NeedleCorner> needle_corners(const Connectivity& surface);

/// Flags the triangles with kappa up to 0.1 that sharp corners of the surface force to be so: connected to
/// the corner by others like them, and where the two feature edges are closer than the triangle is long.
std::vector<char> forced_needles(const Mesh& mesh, const std::vector<float>& kappas,
                                 const std::vector<NeedleCorner>& corners);

/// Returns the smallest kappa of the triangles two rings away from every sharp feature corner (feature edges
/// meet at less than 40 degrees over the surface); 1 if there are none. `worst` becomes the triangle, or -1.
double kappa_off_corners(const Connectivity& surface, const Quality& quality, int& worst);

}  // namespace meshpipe
