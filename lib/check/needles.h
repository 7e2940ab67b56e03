// SPDX-License-Identifier: BSD-3-Clause
// Corners of a surface that are too sharp for good triangles.
#pragma once
#include <vector>

#include "lib/check/quality.h"
#include "lib/core/sectors.h"

namespace meshpipe {

/// Flags the triangles (`kappas`: per triangle) with kappa up to 0.1 that a sharp corner of the reference
/// forces: those in a needle sector of the vertex that stands for the corner, with at least half the kappa of
/// the isosceles triangle that fills it. A strip beyond the corner is not forced: two triangles across it may
/// be as small as it is narrow.
std::vector<char> forced_needles(const Connectivity& result, const std::vector<float>& kappas,
                                 const Connectivity& reference);

/// Returns the smallest kappa of the triangles of which no corner is at, or joined by a triangle to, a sharp
/// feature corner (feature edges meet at less than 40 degrees over the surface); 1 if there are none. `worst`
/// becomes the triangle, or -1.
double kappa_off_corners(const Connectivity& surface, const Quality& quality, int& worst);

}  // namespace meshpipe
