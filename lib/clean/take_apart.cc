// SPDX-License-Identifier: BSD-3-Clause

#include "lib/clean/clean.h"
#include "lib/core/edges.h"
#include "lib/core/lists.h"
#include "lib/core/split_edges.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

/// Moves the points from `first` on, each in the middle of an edge between two others, along their edges
/// where another point is at the same place: on a triangle of zero area.
void move_off_others(std::vector<Vec3>& points, int first, const std::vector<std::array<int, 2>>& ends) {
  const std::vector<char> all(points.size(), 1);
  for (double at : {7 / 16., 9 / 16., 3 / 8., 5 / 8., 1 / 4., 3 / 4.}) {
    const std::vector<int> same = first_equal(points, all);
    bool apart = true;
    for (int v = first; v < (int)points.size(); ++v)
      if (same[v] != v)
        points[v] = lerp(points[ends[v - first][0]], points[ends[v - first][1]], at), apart = false;
    if (apart) return;
  }
}

/// Divides edges where sheets meet and two sides of one have the same copies of both ends: these would be
/// neighbors in that sheet, rather than the sides of a slit. Returns, per triangle, the one it is part of;
/// empty if nothing was divided.
std::vector<int> open_slits(Surface& s) {
  Surface apart = s;
  split_sheets(apart);
  const int n = (int)s.points.size();
  std::vector<int> first(3 * s.tris.size(), -1), middle(first.size(), -1);  // of marked half-edges
  for_each_edge(s.tris, n, [&](std::span<const EdgeUse> uses) {
    bool closes = false;
    auto ends = [&](int h) { return std::minmax({origin(apart.tris, h), target(apart.tris, h)}); };
    for (std::size_t i = 0; uses.size() > 2 && i < uses.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) closes |= ends(half_edge(uses[i])) == ends(half_edge(uses[j]));
    for (EdgeUse e : uses)
      if (closes) first[half_edge(e)] = half_edge(uses[0]);
  });
  std::vector<char> mark;
  std::vector<int> number =
      identity(n);  // of a vertex, those in the middle of half-edges included, which are one
  std::vector<int> rows = number;
  std::vector<std::array<int, 2>> divided;  // the ends of those edges
  for (int h = 0; h < (int)first.size(); ++h) {
    mark.push_back(first[h] >= 0);
    if (first[h] < 0) continue;
    if (first[h] == h) {
      middle[h] = (int)rows.size(), rows.push_back((int)number.size());
      divided.push_back({origin(s.tris, h), target(s.tris, h)});
    }
    number.push_back(middle[first[h]]);
  }
  if ((int)rows.size() == n) return {};
  std::vector<int> none(first.size(), -1);
  const std::vector<int> parent = split_edges({s, none}, std::move(mark), nullptr);
  for (Tri& t : s.tris)
    for (int& v : t) v = number[v];
  for (std::size_t i = 0; i < rows.size(); ++i) s.points[i] = s.points[rows[i]];
  s.points.resize(rows.size());
  move_off_others(s.points, n, divided);
  take_rows(s.vertex, rows);
  return parent;
}

/// Reverses the sheets that have the outside behind them, and a region in front. Returns their number.
int face_outside(Surface& surface, Solids& solids) {
  std::vector<int> component;
  const int n = components(opposite_halfedges(surface), component);
  std::vector<int> balance(n, 0);  // triangles: with the outside in front, less those with it behind
  for (std::size_t t = 0; t < component.size(); ++t)
    balance[component[t]] += (solids.sides[t][1] != 0) - (solids.sides[t][0] != 0);
  for (std::size_t t = 0; t < component.size(); ++t)
    if (balance[component[t]] < 0) {
      std::swap(surface.tris[t][1], surface.tris[t][2]);
      std::swap(solids.sides[t][0], solids.sides[t][1]);
    }
  return (int)std::count_if(balance.begin(), balance.end(), [](int b) { return b < 0; });
}

}  // namespace

RegionReport take_apart(Surface& surface, std::vector<std::array<int, 2>> given) {
  if (const std::vector<int> part_of = open_slits(surface); !given.empty() && !part_of.empty())
    given = rearranged(given, part_of);
  RegionReport report;
  bool meet = false, flips = false;  // more than two triangles, two with different orientation
  for_each_edge(surface.tris, (int)surface.points.size(), [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]), g = half_edge(uses.back());
    if (uses.size() == 1 && report.free_edges++ == 0)
      report.free_at =
          lerp(surface.points[origin(surface.tris, h)], surface.points[target(surface.tris, h)], 0.5);
    meet = meet || uses.size() > 2;
    flips = flips || (h != g && origin(surface.tris, h) == origin(surface.tris, g));
  });
  if (flips && !meet) given.clear();  // there are no regions
  Solids solids{std::vector<std::array<int, 2>>(surface.tris.size(), {0, 0})};
  if (meet || !flips) solids = find_solids(surface);
  report.volume = solids.volume;
  report.label = identity(solids.volume.size());
  if (!given.empty()) report.label = labels_of(solids, given);
  surface.face.erase("model");
  split_sheets(surface);
  report.reversed = face_outside(surface, solids);
  report.sheets = sheet_patches(surface, solids, report.label, report.added);
  return report;
}

}  // namespace meshpipe
