// SPDX-License-Identifier: BSD-3-Clause
// How much a triangulated surface bends, robust to noise and slivers.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns per triangle the largest absolute principal curvature (1 / length): the curvature measure of the
/// edges and the area, both averaged over the same few rings of triangles, so that neither the triangulation
/// nor noise matters, and not across model edges. Triangles without area have that of their neighborhood.
/// Where it is at most `least`, returns some value that is at most `least`, in less time.
/// Source: Cohen-Steiner and Morvan, Restricted Delaunay triangulations and normal cycle, 2003.
std::vector<double> face_curvature(const Connectivity& surface, double least = 0);

}  // namespace meshpipe
