// SPDX-License-Identifier: BSD-3-Clause
// Owners of vertices that take their neighbors, ring by ring.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Lets the owners of vertices (`owner`, 0 or more) take vertices of nobody (-1) for a number of rings: in
/// each ring, the triangles with a vertex of the ring before, in their order, give theirs to their highest
/// owner where of(t, owner). `leaving`: half-edges that leave the owned vertices. Linear in the triangles
/// reached.
template <class Of>
void grow_owners(const Connectivity& c, std::vector<int> leaving, int rings, std::vector<int>& owner, Of of) {
  std::vector<char> seen(c.n_tris(), 0);
  std::vector<int> tris;
  std::vector<std::pair<int, int>> claims;  // a half-edge that leaves the vertex, and the owner
  for (int ring = 0; ring < rings && !leaving.empty(); ++ring) {
    tris.clear();
    for (int h : leaving)
      if (owner[c.from(h)] >= 0)
        c.for_each_spoke(h, [&](int g) {
          if (!seen[g / 3]) tris.push_back(g / 3);
          seen[g / 3] = 1;
        });
    std::sort(tris.begin(), tris.end());
    claims.clear();
    for (int t : tris) {
      const Tri& v = c.mesh.tris[t];
      const int most = std::max({owner[v[0]], owner[v[1]], owner[v[2]]});
      for (int i = 0; i < 3; ++i)
        if (owner[v[i]] == -1 && of(t, most)) claims.push_back({3 * t + i, most});
    }
    leaving.clear();
    for (auto [h, o] : claims) {
      if (owner[c.from(h)] != -1) continue;
      owner[c.from(h)] = o;
      leaving.push_back(h);
    }
  }
}

}  // namespace meshpipe
