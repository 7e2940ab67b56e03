// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/reach_holes.h"

#include <algorithm>

#include "lib/core/shortest_paths.h"

namespace meshpipe {
namespace {

/// How often the side changes from one neighbor of the vertex to the next.
int changes_around(const Connectivity& part, const std::vector<double>& field, int corner) {
  int changes = 0;
  part.for_each_spoke(corner,
                      [&](int h) { changes += (field[part.to(h)] > 0) != (field[part.apex(h)] > 0); });
  return changes;
}

}  // namespace

void reach_holes(const FilledDisk& disk, const Connectivity& part, std::vector<double>& field) {
  const int n = disk.part_vertices;
  const std::vector<Tri>& tris = disk.tris;
  std::vector<int> corner(n, -1), from(n, -1), seen, path, ring;  // corner: a half-edge that leaves
  std::vector<double> distance(n, infinity);
  std::vector<char> on_border(n, 0);
  for (int h = 0; h < 3 * disk.part_tris; ++h) {
    corner[origin(tris, h)] = h;
    if (part.is_border(h)) on_border[origin(tris, h)] = on_border[target(tris, h)] = 1;
  }
  for (std::size_t f = 0; f + 1 < disk.fan_begin.size(); ++f) {
    ring.clear();
    for (int t = disk.fan_begin[f]; t < disk.fan_begin[f + 1]; ++t) ring.push_back(tris[t][0]);
    const bool side = field[ring[0]] > 0;
    if (std::any_of(ring.begin(), ring.end(), [&](int v) { return (field[v] > 0) != side; })) continue;
    for (int v : seen) distance[v] = infinity;
    seen = ring;
    for (int v : ring) distance[v] = 0, from[v] = -1;
    int last = -1;  // of the path: the first vertex with a neighbor on the other side
    shortest_paths(ring, distance, [&](int v, auto reach) {
      for_each_neighbor(tris, part.opposite, corner[v], [&](int w) {
        if ((field[w] > 0) != side)
          last = v;
        else if (!on_border[w] && reach(w, distance[v] + norm(disk.points[w] - disk.points[v])))
          from[w] = v, seen.push_back(w);
      });
      return last < 0;
    });
    if (last < 0) continue;
    path.clear();
    bool cuts_open = true;
    for (int v = last; v >= 0 && cuts_open; v = from[v]) {
      cuts_open = changes_around(part, field, corner[v]) == 2;
      if (cuts_open) {
        field[v] = -field[v];
        path.push_back(v);
      }
    }
    if (!cuts_open)
      for (int v : path) field[v] = -field[v];
  }
}

}  // namespace meshpipe
