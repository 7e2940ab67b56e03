// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/ears.h"

#include "lib/core/cut.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

struct Ear {
  int triangle, tip, left, right;
};

std::vector<Ear> ears_of(const Surface& surface, int n_parts) {
  std::vector<Ear> ears;
  for (const SubMesh& part : split_by_label(surface, surface.face.get<int>("part"), n_parts)) {
    std::vector<int> opposite = opposite_halfedges(part);
    const std::vector<std::vector<int>> loops = boundary_loops(opposite);
    if (loops.empty()) continue;
    const std::vector<int>& longest = loops[longest_loop(part, loops)];
    for (std::size_t i = 0; i < longest.size() && part.tris.size() > 1; ++i) {
      int h = longest[i], g = longest[(i + 1) % longest.size()];
      if (g != next(h)) continue;
      ears.push_back({part.face[h / 3], part.vertex[target(part.tris, h)], part.vertex[origin(part.tris, h)],
                      part.vertex[target(part.tris, g)]});
    }
  }
  return ears;
}

}  // namespace

int split_ears(Surface& surface, int n_parts) {
  int split = 0;
  for (;;) {
    // ears without common vertices, all cut by one field
    std::vector<double> field(surface.points.size(), 0);
    std::vector<char> active(surface.tris.size(), 0), taken(surface.points.size(), 0);
    int n = 0;
    for (const Ear& ear : ears_of(surface, n_parts)) {
      if (taken[ear.tip] || taken[ear.left] || taken[ear.right]) continue;
      taken[ear.tip] = taken[ear.left] = taken[ear.right] = 1;
      field[ear.left] = -1;
      field[ear.right] = 1;
      active[ear.triangle] = 1;
      ++n;
    }
    if (n == 0) return split;
    std::vector<int> side;
    cut_by_scalar_field(surface, field, active, side);
    split += n;
  }
}

}  // namespace meshpipe
