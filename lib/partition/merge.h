// SPDX-License-Identifier: BSD-3-Clause
// Joining neighboring regions of a surface.
#pragma once
#include <algorithm>
#include <tuple>
#include <vector>

#include "lib/core/regions.h"

namespace meshpipe {

/// The border between regions a < b.
struct SharedBorder {
  int a, b;
  double length;
};

/// Returns the borders between labels (per triangle), the longest first. length(h): of a half-edge.
template <class Length>
std::vector<SharedBorder> shared_borders(const Connectivity& mesh, const std::vector<int>& label,
                                         const Regions& regions, Length length) {
  std::vector<SharedBorder> shared;
  for (int a = 0; a < (int)regions.border.size(); ++a)
    for (int h : regions.border[a])
      if (const int o = mesh.opposite[h]; o >= 0 && a < label[o / 3])
        shared.push_back({a, label[o / 3], length(h)});
  std::stable_sort(shared.begin(), shared.end(), [](const SharedBorder& p, const SharedBorder& q) {
    return std::tie(p.a, p.b) < std::tie(q.a, q.b);
  });
  std::size_t n = 0;
  for (const SharedBorder& x : shared)
    if (n > 0 && shared[n - 1].a == x.a && shared[n - 1].b == x.b)
      shared[n - 1].length += x.length;
    else
      shared[n++] = x;
  shared.resize(n);
  std::stable_sort(shared.begin(), shared.end(),
                   [](const SharedBorder& p, const SharedBorder& q) { return p.length > q.length; });
  return shared;
}

/// Joins neighboring regions a, b for which accept(a, b) holds, those with the longest shared border first,
/// until there are none left. `label`: the joiner's; length(h): of a half-edge. A refused pair is asked about
/// again once one of the two has grown. Returns whether any were joined.
template <class Length, class Accept>
bool join_neighbors(Joiner& joiner, const Connectivity& mesh, const std::vector<int>& label, Length length,
                    Accept accept) {
  std::vector<std::pair<int, int>> refused;  // sorted
  for (bool any = false;; any = true) {
    const std::vector<SharedBorder> shared = shared_borders(mesh, label, joiner.regions(), length);
    const auto found = std::find_if(shared.begin(), shared.end(), [&](const SharedBorder& s) {
      const std::pair pair(s.a, s.b);
      const auto place = std::lower_bound(refused.begin(), refused.end(), pair);
      if (place != refused.end() && *place == pair) return false;
      if (accept(s.a, s.b)) return true;
      refused.insert(place, pair);
      return false;
    });
    if (found == shared.end()) return any;
    const int a = found->a, b = found->b;
    joiner.join(a, b);
    std::erase_if(refused,
                  [&](auto& p) { return p.first == a || p.second == a || p.first == b || p.second == b; });
  }
}

}  // namespace meshpipe
