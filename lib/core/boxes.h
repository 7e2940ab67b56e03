// SPDX-License-Identifier: BSD-3-Clause
// Boxes of triangles of a large surface, and what is around each of them.
#pragma once
#include <span>
#include <vector>

#include "lib/core/lists.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Distributes triangles to boxes of at most `most` of them, by splits across their longest extent. Returns
/// their rows, ascending in each box.
std::vector<std::vector<int>> split_into_boxes(const Mesh& mesh, const std::vector<int>& triangles, int most);

/// Returns for each tile, a list of triangles of the mesh, the triangles near it: all within `reach` extents,
/// or the length `least`, of the bounding box of one of its triangles, and some farther ones; of `reference`,
/// or where that is null, of the mesh without the tile.
Lists around_tiles(const Mesh& mesh, const std::vector<std::vector<int>>& tiles, double reach,
                   const Mesh* reference, double least = 0);

/// Returns these triangles as a mesh of their own. `vertices`, if given, receives the rows of its vertices.
Mesh part_of(const Mesh& mesh, std::span<const int> triangles, std::vector<int>* vertices = nullptr);

}  // namespace meshpipe
