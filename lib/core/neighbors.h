// SPDX-License-Identifier: BSD-3-Clause
// A mesh as a graph of its edges.
#pragma once
#include <numeric>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// The vertices at the other ends of the edges at each vertex. Linear.
struct Neighbors {
  std::vector<int> start, vertex;  ///< vertex[start[v]..start[v+1]): inner ones twice
  explicit Neighbors(const Mesh& mesh) : start(mesh.points.size() + 1, 0), vertex(6 * mesh.tris.size()) {
    for (const Tri& t : mesh.tris)
      for (int v : t) start[v + 1] += 2;
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<int> at(start.begin(), start.end() - 1);
    for (const Tri& t : mesh.tris)
      for (int i = 0; i < 3; ++i) {
        vertex[at[t[i]]++] = t[(i + 1) % 3];
        vertex[at[t[i]]++] = t[(i + 2) % 3];
      }
  }
};

}  // namespace meshpipe
