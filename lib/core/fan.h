// SPDX-License-Identifier: BSD-3-Clause
// Walks around a vertex and along a border.
#pragma once
#include <type_traits>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Calls visit(g) for every half-edge g that leaves the origin of h in its fan: h, then counterclockwise;
/// where the fan is open, then clockwise from h to the fan's other end. If `visit` returns bool, false stops
/// the walk. `beyond` holds the opposite of each half-edge, -1 at what bounds fans. Returns whether the fan
/// is closed and all of it was visited.
template <class Visit>
bool for_each_spoke(const std::vector<int>& beyond, int h, Visit visit) {
  auto goes_on = [&](int g) {
    if constexpr (std::is_same_v<decltype(visit(g)), bool>)
      return visit(g);
    else
      return visit(g), true;
  };
  const int first = h;
  do {
    if (!goes_on(h)) return false;
    h = beyond[prev(h)];
  } while (h >= 0 && h != first);
  if (h == first) return true;
  for (h = beyond[first]; h >= 0; h = beyond[h])
    if (!goes_on(h = next(h))) return false;
  return false;
}

/// Calls visit(v) for the vertices joined to the origin of h by an edge of its fan, in the order of
/// for_each_spoke; where the fan is open, the last one counterclockwise follows the vertex before it.
template <class Visit>
void for_each_neighbor(const std::vector<Tri>& tris, const std::vector<int>& beyond, int h, Visit visit) {
  for_each_spoke(beyond, h, [&](int g) {
    visit(target(tris, g));
    if (beyond[prev(g)] < 0) visit(origin(tris, prev(g)));
  });
}

/// Holds for every triangle.
struct Everywhere {
  bool operator()(int) const { return true; }
};

/// Returns the border half-edge of a region that starts where its border half-edge h ends, around that
/// vertex. `inside(t)` returns whether triangle t is in the region.
template <class Inside = Everywhere>
int next_on_border(const std::vector<int>& opposite, int h, Inside inside = {}) {
  h = next(h);
  while (opposite[h] >= 0 && inside(opposite[h] / 3)) h = next(opposite[h]);
  return h;
}

}  // namespace meshpipe
