// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/filled_disk.h"

#include <algorithm>

#include "lib/core/topology.h"
#include "lib/numeric/laplacian.h"

namespace meshpipe {
namespace {

// positive weights make the map of a disk one-to-one (Floater 1997); raised by the edge and not by the
// triangle, since raising more than needed twists tubes whose diagonals all lean to one side
constexpr double least_weight = 1e-3;

}  // namespace

bool encloses(const std::vector<Vec2>& polygon, Vec2 p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    Vec2 a = polygon[j], b = polygon[i];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

FilledDisk fill_holes(const Mesh& part) {
  FilledDisk disk;
  disk.points = part.points;
  disk.tris = part.tris;
  disk.part_vertices = part.points.size();
  disk.part_tris = part.tris.size();
  disk.opposite = opposite_halfedges(part.tris, part.points.size());
  const std::vector<std::vector<int>> loops = boundary_loops(disk.opposite);
  const std::size_t longest = longest_loop(part, loops);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (l == longest) {
      for (int h : loops[l]) disk.rim.push_back(origin(part.tris, h));
      continue;
    }
    const int first = disk.tris.size(), n = loops[l].size();
    disk.fan_begin.push_back(first);
    Vec3 center;
    for (int h : loops[l]) center = center + (1. / loops[l].size()) * part.points[origin(part.tris, h)];
    for (int i = 0; i < n; ++i) {
      const int h = loops[l][i], t = first + i;
      disk.tris.push_back({target(part.tris, h), origin(part.tris, h), (int)disk.points.size()});
      disk.opposite[h] = 3 * t;  // and its neighbors in the fan: the half-edge before on the loop, the next
      disk.opposite.insert(disk.opposite.end(),
                           {h, 3 * (first + (i + n - 1) % n) + 2, 3 * (first + (i + 1) % n) + 1});
    }
    disk.points.push_back(center);
  }
  disk.fan_begin.push_back(disk.tris.size());
  disk.weights.resize(3 * disk.tris.size());
  for (std::size_t t = 0; t < disk.tris.size(); ++t) {
    const Tri& c = disk.tris[t];
    auto w = cotangent_weights(disk.points[c[0]], disk.points[c[1]], disk.points[c[2]]);
    std::copy(w.begin(), w.end(), disk.weights.begin() + 3 * t);
  }
  for (int h = 0; h < (int)disk.weights.size(); ++h) {
    const int o = disk.opposite[h];
    if (o < 0)
      disk.weights[h] = std::max(disk.weights[h], least_weight);
    else if (o > h)
      disk.weights[h] = disk.weights[o] = std::max((disk.weights[h] + disk.weights[o]) / 2, least_weight);
  }
  return disk;
}

}  // namespace meshpipe
