// SPDX-License-Identifier: BSD-3-Clause
// The intrinsic Delaunay triangulation of a surface: its edges are straight on the surface, not in space.
#pragma once
#include "lib/param/disk.h"

namespace meshpipe {

/// Flips the inner edges of a filled part, as straight lines on the surface, until the two angles opposite to
/// every edge sum to at most 180 degrees: the same vertices, metric and border edges, and cotangent weights
/// that are not negative. Two vertices may then share several edges, and an edge may be a loop. Edges of
/// degenerate triangles are lengthened first (Sharp and Crane 2020). Each triangle has a scale of its own.
/// Near-linear in practice.
/// Source: Fisher, Springborn, Schroeder and Bobenko 2007.
Filled intrinsic_delaunay(Filled filled);

}  // namespace meshpipe
