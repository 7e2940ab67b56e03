// SPDX-License-Identifier: BSD-3-Clause
// Model edges that are given as segments in space: they stay valid however the surface is renumbered or cut.
#pragma once
#include "lib/core/mesh.h"

namespace meshpipe {

/// Model edges as segments: segment i joins tris[i][0] and tris[i][1] (the third corner repeats the second),
/// with a label (0: none) and the two flags of INRIA's formats (0 or 1).
struct ModelSegments : Mesh {
  std::vector<int> tag, ridge, required;
};

/// Returns per half-edge the segment nearest to its midpoint, if its ends and midpoint are within 1e-6 of the
/// mesh's diagonal from segments; else -1. The same for both half-edges of an edge.
std::vector<int> segments_under(const Mesh& mesh, const ModelSegments& segments);

/// Returns the segments for a mesh that has changed into `after`: those under edges become one per edge of
/// `after`, with the same label and flags; the others stay. `under`, `under_after`: as from segments_under,
/// for the mesh before and after.
ModelSegments moved_segments(const ModelSegments& segments, const std::vector<int>& under, const Mesh& after,
                             const std::vector<int>& under_after);

/// Returns the segments for a surface whose open ends were treated (lib/cap). If `after` begins with the
/// triangles of `before`, segments move with their vertices; else those on rims of `before` that are on no
/// edge of `after` are dropped. The rims of caps are model edges in any case. Throws: as opposite_halfedges.
ModelSegments segments_after_ends(const ModelSegments& segments, const Mesh& before, const Mesh& after);

}  // namespace meshpipe
