// SPDX-License-Identifier: BSD-3-Clause
// Boxes of triangles of a large surface, and what is around each of them.
#pragma once
#include <numeric>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Distributes triangles to boxes of at most `most` of them, by splits across their longest extent. Returns
/// their rows, ascending in each box.
std::vector<std::vector<int>> split_into_boxes(const Mesh& mesh, const std::vector<int>& triangles, int most);

/// Rows by key, one list after the other: of key k those from start[k] to start[k + 1].
struct Lists {
  std::vector<int> start, row;
};

/// The lists of the pairs (key, row) that `each` calls its argument for.
template <class Each>
Lists lists_of(int keys, Each each) {
  Lists lists{std::vector<int>(keys + 1, 0), {}};
  each([&](int key, int) { ++lists.start[key + 1]; });
  std::partial_sum(lists.start.begin(), lists.start.end(), lists.start.begin());
  lists.row.resize(lists.start.back());
  std::vector<int> at(lists.start.begin(), lists.start.end() - 1);
  each([&](int key, int row) { lists.row[at[key]++] = row; });
  return lists;
}

template <class F>
void for_rows(const Lists& lists, int key, F f) {
  for (int i = lists.start[key]; i < lists.start[key + 1]; ++i) f(lists.row[i]);
}

/// Returns for each of several tiles the triangles of the reference that are no farther from it than `reach`
/// of its edges, and some others; where `reference` is null, triangles of the mesh that are not in the tile.
Lists around_tiles(const Mesh& mesh, const std::vector<std::vector<int>>& boxes, double reach,
                   const Mesh* reference);

}  // namespace meshpipe
