// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/sheets.h"

#include <algorithm>
#include <cmath>

#include "lib/core/connectivity.h"
#include "lib/core/edges.h"
#include "lib/core/junctions.h"
#include "lib/core/number.h"
#include "lib/core/triangle_count.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

using Key = std::vector<int>;  ///< of a line: its sheets' patches, ascending; or their number

/// The lines where more than two triangles meet, and free edges.
struct Junctions {
  std::vector<Key> lines;  ///< one per line, sorted
  int corners = 0;
  std::vector<int> free;                  ///< patches with free edges, ascending
  std::vector<std::array<int, 2>> edges;  ///< free edges: patch and triangle
};

/// Flags half-edges inside of sheets.
std::vector<char> inside_sheets(const Mesh& apart) {
  std::vector<char> inside(3 * apart.tris.size(), 0);
  for_each_edge(apart.tris, (int)apart.points.size(), [&](std::span<const EdgeUse> uses) {
    for (EdgeUse e : uses) inside[half_edge(e)] = uses.size() > 1;
  });
  return inside;
}

/// The junctions of borders. That the inside of a sheet touches one is an intersection, and changes nothing.
Junctions junctions_of(const Mesh& joined, const std::vector<char>& inside, const std::vector<int>& patch,
                       bool named) {
  Junctions j;
  struct Edge {
    int a, b;
    Key key;
  };
  std::vector<Edge> edges;
  std::vector<int> borders;
  for_each_edge(joined.tris, (int)joined.points.size(), [&](std::span<const EdgeUse> uses) {
    borders.clear();
    for (EdgeUse e : uses)
      if (!inside[half_edge(e)]) borders.push_back(half_edge(e));
    if (borders.size() == 1) j.edges.push_back({patch[borders[0] / 3], borders[0] / 3});
    if (borders.size() < 2) return;
    const int h = borders[0];
    Key key;
    if (!named) key.push_back((int)borders.size());
    for (int border : borders)
      if (named) key.push_back(patch[border / 3]);
    std::sort(key.begin(), key.end());
    edges.push_back({origin(joined.tris, h), target(joined.tris, h), std::move(key)});
  });
  std::vector<std::array<int, 3>> at(joined.points.size(), {-1, -1, 0});  // two edges, and their number
  for (int e = 0; e < (int)edges.size(); ++e)
    for (int v : {edges[e].a, edges[e].b})
      if (at[v][2]++ < 2) at[v][at[v][2] - 1] = e;
  UnionFind line(edges.size());
  for (const auto& [e, f, n] : at) {
    if (n == 0) continue;
    if (n == 2 && edges[e].key == edges[f].key)
      line.join(e, f);
    else
      ++j.corners;
  }
  for (int e = 0; e < (int)edges.size(); ++e)
    if (line.find(e) == e) j.lines.push_back(edges[e].key);
  std::sort(j.lines.begin(), j.lines.end());
  for (const auto& [p, t] : j.edges) j.free.push_back(p);
  sort_unique(j.free);
  return j;
}

std::string shown(const Key& key, bool named) {
  if (!named) return std::to_string(key[0]) + " triangles around it";
  std::string text = "patches";
  for (int p : key) text += ' ' + std::to_string(p);
  return text;
}

void compare_lines(const Junctions& r, const Junctions& m, bool named, SheetFindings& f) {
  auto flips = [&](const Key& key) { return named ? key.size() == 2 : key[0] == 2; };
  f.flips = {(int)std::count_if(r.lines.begin(), r.lines.end(), flips),
             (int)std::count_if(m.lines.begin(), m.lines.end(), flips)};
  f.lines = {(int)r.lines.size() - f.flips[0], (int)m.lines.size() - f.flips[1]};
  f.corners = {r.corners, m.corners};
  std::vector<Key> lost, gained;
  std::set_difference(r.lines.begin(), r.lines.end(), m.lines.begin(), m.lines.end(),
                      std::back_inserter(lost));
  std::set_difference(m.lines.begin(), m.lines.end(), r.lines.begin(), r.lines.end(),
                      std::back_inserter(gained));
  for (const auto& [which, what] :
       {std::pair{&lost, " of the reference's are missing"}, {&gained, " are new"}})
    if (!which->empty())
      f.faults.push_back(std::to_string(which->size()) + " lines where sheets meet" + what +
                         ", the first with " + shown((*which)[0], named));
  if (r.corners != m.corners)
    f.faults.push_back(std::to_string(m.corners) + " points where such lines end, the reference has " +
                       std::to_string(r.corners));
  for (const auto& [patch, t] : m.edges)
    if (named ? !std::binary_search(r.free.begin(), r.free.end(), patch) : r.free.empty())
      f.unmatched.push_back(t);
}

std::string name_of(int label) { return label > 0 ? "region " + std::to_string(label) : "the outside"; }

/// The volume between the boundary of a region and a surface that is a share of an edge length away.
double offset_of(const RegionMeasure& r) {
  constexpr double most_offset = 0.1;  // of the edge length: chords sag so much at a radius of 1.25 edges
  return most_offset * size_for_count(r.area, r.triangles) * r.area;
}

/// Checks that the regions found in the mesh have the labels that the table of sheets says.
void compare_labels(const Solids& solids, const std::vector<int>& patch,
                    const std::vector<SheetPatch>& sheets, SheetFindings& f) {
  constexpr int unknown = -1;
  std::vector<int> triangle(solids.volume.size(), unknown), label(solids.volume.size(), 0);
  for (int t = 0; t < (int)patch.size(); ++t) {
    const SheetPatch* s = find_sheet(sheets, patch[t]);
    if (!s) continue;
    for (int i : {0, 1}) {
      const int region = solids.sides[t][i], here = i ? s->back : s->front;
      if (triangle[region] == unknown) triangle[region] = t, label[region] = here;
      if (label[region] == here) continue;
      f.faults.push_back("triangle " + std::to_string(t) + " bounds " + name_of(here) +
                         ", which is one with " + name_of(label[region]) + " at triangle " +
                         std::to_string(triangle[region]));
      return;
    }
  }
}

/// Compares the regions that the sheets of both surfaces, {reference, result}, enclose.
void compare_regions(const Mesh (&joined)[2], const Surface* const (&surface)[2],
                     const std::vector<SheetPatch>& sheets, bool named, SheetFindings& f) {
  Solids solids[2];
  for (int i : {0, 1}) {
    solids[i] = find_solids(joined[i]);
    f.regions[i] = solids[i].count();
  }
  if (f.regions[0] != f.regions[1])
    f.faults.push_back(std::to_string(f.regions[1]) + " regions, the reference has " +
                       std::to_string(f.regions[0]));
  if (named) {
    compare_labels(solids[1], surface[1]->face.get<int>("patch"), sheets, f);
    const std::vector<RegionMeasure> was = measure_regions(*surface[0], sheets),
                                     is = measure_regions(*surface[1], sheets);
    for (std::size_t i = 0; i < is.size(); ++i)
      if (const RegionMeasure& r = is[i]; r.label > 0)
        f.volumes.push_back({r.label, was[i].volume, r.volume, offset_of(r)});
  } else if (f.regions[0] == f.regions[1]) {
    std::vector<RegionMeasure> regions(f.regions[1] + 1);
    for (int i = 1; i <= f.regions[1]; ++i) regions[i].volume = solids[1].volume[i];
    for (int t = 0; t < (int)joined[1].tris.size(); ++t)
      for (int side : solids[1].sides[t]) {
        regions[side].area += 0.5 * norm(area_vector(joined[1], t));
        ++regions[side].triangles;
      }
    std::sort(regions.begin() + 1, regions.end(),
              [](const auto& a, const auto& b) { return a.volume < b.volume; });
    std::sort(solids[0].volume.begin() + 1, solids[0].volume.end());
    for (int i = 1; i <= f.regions[0]; ++i)
      f.volumes.push_back({i, solids[0].volume[i], regions[i].volume, offset_of(regions[i])});
  }
  for (int i = 0; i < (int)f.volumes.size(); ++i) {
    const RegionVolume& v = f.volumes[i];
    const double error =
        v.reference != 0 ? std::abs(v.result - v.reference) / std::abs(v.reference) : v.result != 0;
    if (f.worst < 0 || error > f.volume_error) f.volume_error = error, f.worst = i;
  }
}

}  // namespace

std::vector<int> slits_of(const Mesh& mesh) {
  std::vector<char> free(3 * mesh.tris.size(), 0);
  for_each_edge(mesh.tris, (int)mesh.points.size(),
                [&](std::span<const EdgeUse> uses) { free[half_edge(uses[0])] = uses.size() == 1; });
  Mesh joined = mesh;
  join_borders(joined);
  std::vector<int> slits;
  for_each_edge(joined.tris, (int)joined.points.size(), [&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2 || !free[half_edge(uses[0])] || !free[half_edge(uses[1])]) return;
    for (EdgeUse e : uses) slits.push_back(half_edge(e) / 3);
  });
  sort_unique(slits);
  return slits;
}

SheetFindings compare_sheets(const Surface& reference, const Surface& result,
                             const std::vector<SheetPatch>& sheets, bool named, bool solid) {
  SheetFindings f;
  Mesh joined[2] = {reference, result};
  Junctions junctions[2];
  const Surface* surface[2] = {&reference, &result};
  for (int i : {0, 1}) {
    const std::vector<char> inside = inside_sheets(joined[i]);
    join_borders(joined[i]);
    const std::vector<int> none(joined[i].tris.size(), 0);
    junctions[i] = junctions_of(joined[i], inside, named ? surface[i]->face.get<int>("patch") : none, named);
  }
  compare_lines(junctions[0], junctions[1], named, f);
  if (!f.unmatched.empty())
    f.faults.push_back(std::to_string(f.unmatched.size()) +
                       " edges of sheets have no other at their place, the first in triangle " +
                       std::to_string(f.unmatched[0]));
  if (solid) compare_regions(joined, surface, sheets, named, f);
  return f;
}

}  // namespace meshpipe
