// SPDX-License-Identifier: BSD-3-Clause
// A mesh as a graph of its edges.
#pragma once
#include <utility>
#include <vector>

#include "lib/core/lists.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// The vertices at the other ends of the edges at each vertex. Linear.
struct Neighbors {
  std::vector<int> start, vertex;  ///< vertex[start[v]..start[v+1]): inner ones twice
  explicit Neighbors(const Mesh& mesh) {
    Lists lists = lists_of((int)mesh.points.size(), [&](auto use) {
      for (const auto& [a, b, c] : mesh.tris)
        use(a, b), use(a, c), use(b, c), use(b, a), use(c, a), use(c, b);
    });
    start = std::move(lists.start), vertex = std::move(lists.row);
  }
};

}  // namespace meshpipe
