// SPDX-License-Identifier: BSD-3-Clause
// The intrinsic Delaunay triangulation of a surface: straight edges on it, whatever its triangles are like.
#pragma once
#include "lib/param_disk.h"

namespace meshpipe {

/// Flips the inner edges of a filled part, as straight lines on the surface, until the angles opposite to
/// every edge add up to at most 180 degrees (Fisher, Springborn, Schroeder and Bobenko 2007): the same
/// vertices, the same metric, the same border edges, and cotangent weights that are not negative and do not
/// suffer from needles and obtuse triangles. Two vertices may share several edges then, and an edge may be a
/// loop. Triangles that are flat have their edges lengthened alike, by the least that makes them proper ones
/// (Sharp and Crane 2020). Scales of triangles do not count: shapes of neighbours may give their edge
/// different lengths. Near-linear in practice; linear if nothing is to be flipped.
Filled intrinsic_delaunay(Filled filled);

}  // namespace meshpipe
