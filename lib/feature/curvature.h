// SPDX-License-Identifier: BSD-3-Clause
// How much a triangulated surface bends, robust to noise and slivers.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns the largest absolute principal curvature (one over a length) at every triangle: the curvature
/// measure of the edges and the area, both averaged over the same few rings of triangles, so that neither the
/// triangulation nor noise matters. Nothing is averaged across model edges. Triangles without area have the
/// curvature of their neighborhood. Where it is at most `least`, what is returned is some bound that is not
/// above it: that takes less time.
/// Source: Cohen-Steiner and Morvan, "Restricted Delaunay triangulations and normal cycle", 2003.
std::vector<double> face_curvature(const Connectivity& surface, double least = 0);

}  // namespace meshpipe
