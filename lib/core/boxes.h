// SPDX-License-Identifier: BSD-3-Clause
// Boxes of triangles of a large surface, and what is around each of them.
#pragma once
#include <span>
#include <vector>

#include "lib/core/lists.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Distributes triangles (rows of the mesh) to boxes of at most `most`, by splits across the longest extent
/// of their centroids. Returns the rows of each box, ascending.
std::vector<std::vector<int>> split_into_boxes(const Mesh& mesh, const std::vector<int>& triangles, int most);

/// Returns for each tile (a list of triangles of the mesh, each in one tile at most) the triangles near it:
/// all within `reach` times the longest side of the bounding box of one of its triangles, at least the length
/// `least`; and some farther ones. They are of `reference`; where that is null, of the mesh outside the tile.
Lists around_tiles(const Mesh& mesh, const std::vector<std::vector<int>>& tiles, double reach,
                   const Mesh* reference, double least = 0);

/// Returns these triangles, in their order, as a mesh of their own. `vertices`, if given, receives for each
/// of its vertices the row in `mesh`.
Mesh part_of(const Mesh& mesh, std::span<const int> triangles, std::vector<int>* vertices = nullptr);

}  // namespace meshpipe
