// SPDX-License-Identifier: BSD-3-Clause
// The triangles around an edge in angular order.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Sorts the half-edges of one edge around it: counterclockwise, seen against the direction from the edge's
/// smaller to its larger vertex, from the first one on. `above(t, v)` returns the side of triangle t on which
/// vertex v lies: +1 where the normal points to, -1 the other, 0 in its plane. The sides of triangle t have
/// numbers: 2 t is the one in front, 2 t + 1 the one behind.
template <class Above>
class Around {
 public:
  Around(const std::vector<Tri>& tris, Above above) : tris_(tris), above_(std::move(above)) {}
  bool forward(int h) const { return origin(tris_, h) < target(tris_, h); }
  /// Returns the side of triangle h / 3 towards the triangles after it in that order, with `back` before it.
  int side(int h, bool back = false) const { return 2 * (h / 3) + (forward(h) == back); }
  void sort(std::vector<int>& edge) const {
    const int first = edge[0];
    std::vector<std::pair<int, int>> order;  // first the half turn, then the half-edge
    for (int h : edge) {
      const int s = h == first ? 2 : turn(first, h);
      order.push_back({h == first ? -1 : s > 0 ? 0 : s == 0 ? 1 : 2, h});
    }
    std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
      if (a.first != b.first) return a.first < b.first;
      return a.second != b.second && turn(a.second, b.second) > 0;
    });
    for (std::size_t i = 0; i < edge.size(); ++i) edge[i] = order[i].second;
  }

 private:
  /// Returns +1 if g is within half a turn after h, -1 if before, 0 if in its plane.
  int turn(int h, int g) const {
    const int s = above_(h / 3, origin(tris_, prev(g)));
    return forward(h) ? s : -s;
  }
  const std::vector<Tri>& tris_;
  Above above_;
};

}  // namespace meshpipe
