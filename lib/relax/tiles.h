// SPDX-License-Identifier: BSD-3-Clause
// Tiles of a large mesh: pieces that are optimized by themselves, with held rims, on the slice of the
// reference below them; for lib/relax/ only.
#pragma once
#include "lib/core/boxes.h"
#include "lib/relax/relax.h"

namespace meshpipe {

/// Returns for each vertex its triangles, ascending.
Lists triangles_at_vertices(const Mesh& mesh);

/// Cuts the triangles boxes[tile] out of the mesh as a tile, with the slice `faces[tile]` (rows) of the
/// reference and others[tile] of the mesh around it (`others` empty: none). `at_vertex`:
/// triangles_at_vertices.
Tile cut_tile(const TiledMesh& whole, const Lists& at_vertex, const Surface& reference,
              const std::vector<char>& corner, const std::vector<std::vector<int>>& boxes, const Lists& faces,
              const Lists& others, int tile);

/// Returns the pairs of triangles that intersect and may be in different boxes (lists of triangles), sorted:
/// tested are triangles within `reach` extents of another box (around_tiles).
std::vector<std::pair<int, int>> tile_intersections(const Mesh& mesh,
                                                    const std::vector<std::vector<int>>& boxes, double reach);

/// Returns the triangles up to `rings` vertices away from one of these (1: those that have it), ascending.
std::vector<int> triangles_near(const Mesh& mesh, const std::vector<int>& vertices, int rings);

}  // namespace meshpipe
