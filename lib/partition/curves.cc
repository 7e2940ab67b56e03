// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/curves.h"

#include <array>
#include <set>

namespace meshpipe {

std::vector<Curve> find_curves(const CutSurface& cut) {
  const Surface& s = cut.surface;
  const std::vector<int>& opposite = cut.opposite;
  const std::vector<int>& part = s.face.get<int>("part");
  // an edge in the curve: its parts, the vertex where it begins, which it does but once, and the half-edge
  std::vector<std::array<int, 4>> pieces;
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] >= 0 && part[h / 3] < part[opposite[h] / 3])
      pieces.push_back({part[h / 3], part[opposite[h] / 3], origin(s.tris, h), h});
  std::sort(pieces.begin(), pieces.end());

  std::vector<int> follower(pieces.size(), -1);
  std::vector<char> follows(pieces.size(), 0), used(pieces.size(), 0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& [a, b, from, h] = pieces[i];
    const std::array<int, 4> next{a, b, target(s.tris, h), 0};
    const auto it = std::lower_bound(pieces.begin(), pieces.end(), next);
    if (it == pieces.end() || !std::equal(next.begin(), next.end() - 1, it->begin())) continue;
    follower[i] = (int)(it - pieces.begin());
    follows[follower[i]] = 1;
  }
  std::vector<Curve> curves;
  for (bool closed : {false, true})
    for (int i = 0; i < (int)pieces.size(); ++i) {
      if (used[i] || (!closed && follows[i])) continue;
      Curve c{pieces[i][0], pieces[i][1], {}};
      for (int k = i; k >= 0 && !used[k]; k = follower[k]) {
        used[k] = 1;
        c.half_edges.push_back(pieces[k][3]);
      }
      curves.push_back(std::move(c));
    }
  return curves;
}

Handle handle_of(const Mesh& m, const Curve& c) {
  const int h = c.half_edges[c.half_edges.size() / 2];
  return {origin(m.tris, h), target(m.tris, h)};
}

bool has_handle(const Mesh& m, const Curve& c, const std::vector<Handle>& handles) {
  return std::any_of(c.half_edges.begin(), c.half_edges.end(), [&](int h) {
    return std::binary_search(handles.begin(), handles.end(), Handle{origin(m.tris, h), target(m.tris, h)});
  });
}

std::map<Pair, int> color_pairs(const Surface& s, const std::vector<Curve>& curves) {
  std::map<Pair, std::set<int>> ends;  // vertices
  std::map<int, std::set<Pair>> at_end;
  for (const Curve& c : curves)
    for (int v : {origin(s.tris, c.half_edges.front()), target(s.tris, c.half_edges.back())}) {
      ends[{c.a, c.b}].insert(v);
      at_end[v].insert({c.a, c.b});
    }
  std::map<Pair, int> color;
  std::map<Pair, std::set<int>> taken;
  for (const auto& [pair, vertices] : ends) {
    int& mine = color[pair];
    while (taken[pair].contains(mine)) ++mine;
    for (int v : vertices)
      for (const Pair& other : at_end[v]) taken[other].insert(mine);
  }
  return color;
}

}  // namespace meshpipe
