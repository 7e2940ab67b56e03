// SPDX-License-Identifier: BSD-3-Clause
// Tiles of a large mesh: pieces that are optimized by themselves, with held rims, on the slice of the
// reference below them; for lib/relax/ only.
#pragma once
#include "lib/core/boxes.h"
#include "lib/relax/relax.h"

namespace meshpipe {

Lists triangles_at_vertices(const Mesh& mesh);

/// Cuts the tile with number `tile` of these boxes out, with the slice of the reference around it. `others`:
/// the triangles of the mesh around it; empty: none.
Tile cut_tile(const TiledMesh& whole, const Lists& at_vertex, const Surface& reference,
              const std::vector<char>& corner, const std::vector<std::vector<int>>& boxes, const Lists& faces,
              const Lists& others, int tile);

/// Returns the pairs of triangles that intersect and may be in different boxes, sorted.
std::vector<std::pair<int, int>> tile_intersections(const Mesh& mesh,
                                                    const std::vector<std::vector<int>>& boxes, double reach);

/// Returns the triangles that are up to `rings` vertices away from one of these, ascending.
std::vector<int> triangles_near(const Mesh& mesh, const std::vector<int>& vertices, int rings);

}  // namespace meshpipe
