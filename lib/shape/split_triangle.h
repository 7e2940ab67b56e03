// SPDX-License-Identifier: BSD-3-Clause
// Division of a triangle into k^2 triangles.
#pragma once
#include <algorithm>
#include <array>
#include <utility>

#include "lib/core/mesh.h"

namespace meshpipe {

/// A point of a triangle: its corners with how many k-ths of each it consists of, ordered by corner, so that
/// sums in both triangles of an edge are the same to the last bit.
using CornerShares = std::array<std::pair<int, int>, 3>;

/// Appends the k^2 triangles into which t is divided, on points of their own, point(shares).
template <class F>
void add_split_triangle(Mesh& mesh, int k, const Tri& t, F&& point) {
  const int first = (int)mesh.points.size();
  for (int j = 0; j <= k; ++j)
    for (int i = 0; i <= k - j; ++i) {
      CornerShares shares{{{t[0], k - i - j}, {t[1], i}, {t[2], j}}};
      std::sort(shares.begin(), shares.end());
      mesh.points.push_back(point(shares));
    }
  for (int j = 0, row = first; j < k; ++j) {
    const int above = row + k - j + 1;
    for (int i = 0; i < k - j; ++i) {
      mesh.tris.push_back({row + i, row + i + 1, above + i});
      if (i + 1 < k - j) mesh.tris.push_back({row + i + 1, above + i + 1, above + i});
    }
    row = above;
  }
}

}  // namespace meshpipe
