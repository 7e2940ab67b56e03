// SPDX-License-Identifier: BSD-3-Clause
// A mesh as a graph of its edges.
#pragma once
#include "lib/core/lists.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns the vertices at the other ends of the edges at each vertex: inner ones twice. Linear.
inline Lists neighbors_of(const Mesh& mesh) {
  return lists_of((int)mesh.points.size(), [&](auto use) {
    for (const auto& [a, b, c] : mesh.tris) use(a, b), use(a, c), use(b, c), use(b, a), use(c, a), use(c, b);
  });
}

}  // namespace meshpipe
