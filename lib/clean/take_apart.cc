// SPDX-License-Identifier: BSD-3-Clause
#include <numeric>

#include "lib/clean/clean.h"
#include "lib/core/edges.h"
#include "lib/core/error.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// As sheets_apart, with columns.
void split(Surface& s) {
  const std::size_t n = s.tris.size();
  const CleanReport r = clean(s, {.weld = 0, .sheets = CleanOptions::split});
  if (s.tris.size() != n || r.flipped || r.degenerate || r.duplicate)
    throw NotAdmissible("the surface has " + std::to_string(r.flipped) + " misoriented, " +
                        std::to_string(r.degenerate) + " degenerate, " + std::to_string(r.duplicate) +
                        " duplicate triangles; run mclean first");
}

/// Reverses the sheets that have the outside behind them, and a region in front.
void face_outside(Surface& surface, Solids& solids) {
  std::vector<int> component;
  const int n = components(opposite_halfedges(surface.tris, (int)surface.points.size()), component);
  std::vector<int> balance(n, 0);  // triangles: with the outside in front, less those with it behind
  for (std::size_t t = 0; t < component.size(); ++t)
    balance[component[t]] += (solids.sides[t][1] != 0) - (solids.sides[t][0] != 0);
  for (std::size_t t = 0; t < component.size(); ++t)
    if (balance[component[t]] < 0) {
      std::swap(surface.tris[t][1], surface.tris[t][2]);
      std::swap(solids.sides[t][0], solids.sides[t][1]);
    }
}

}  // namespace

RegionReport take_apart(Surface& surface, const std::vector<std::array<int, 2>>& given) {
  Solids solids = find_solids(surface);
  RegionReport report;
  report.volume = solids.volume;
  report.label.resize(solids.volume.size());
  std::iota(report.label.begin(), report.label.end(), 0);
  if (!given.empty()) report.label = labels_of(solids, given);
  for_each_edge(surface.tris, (int)surface.points.size(), [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]);
    if (uses.size() == 1 && report.free_edges++ == 0)
      report.free_at =
          lerp(surface.points[origin(surface.tris, h)], surface.points[target(surface.tris, h)], 0.5);
  });
  surface.face.erase("model");
  split(surface);
  face_outside(surface, solids);
  report.sheets = sheet_patches(surface, solids, report.label, report.added);
  return report;
}

}  // namespace meshpipe
