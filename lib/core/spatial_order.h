// SPDX-License-Identifier: BSD-3-Clause
// Orders in which neighbors in space are near each other in memory, too.
#pragma once
#include "lib/core/take_rows.h"

namespace meshpipe {

/// A new order of the rows of a mesh: row i was row vertices[i], or tris[i].
struct SpatialOrder {
  std::vector<int> vertices, tris;
};

/// Orders vertices along Hilbert's curve, and triangles by the first of their vertices along it.
SpatialOrder spatial_order(const Mesh& mesh);

/// Returns the new row of every old one: the inverse of `order`.
std::vector<int> new_rows(const std::vector<int>& order);

/// Renumbers the vertices, of n, that triangles use by first use. Returns the former number of each.
std::vector<int> number_by_first_use(std::vector<Tri>& tris, std::size_t n);

/// Puts points and triangles into an order; triangles keep their first corner.
void rearrange(Mesh& mesh, const SpatialOrder& order);

}  // namespace meshpipe
