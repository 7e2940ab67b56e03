// SPDX-License-Identifier: BSD-3-Clause
// Triangles that lie on others: second copies of a sheet, and contacts between two solids.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>

#include "lib/clean/repair.h"
#include "lib/core/edges.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

constexpr double flat = 5 * std::numbers::pi / 180;  ///< bend along a diagonal that may run the other way

/// Whether two triangles of the same vertices have the same orientation.
bool same_orientation(const Tri& t, const Tri& u) {
  const int i = (int)(std::find(t.begin(), t.end(), u[0]) - t.begin());
  return t[(i + 1) % 3] == u[1];
}

/// Two triangles with a common edge, nearly in one plane.
struct Quad {
  std::array<int, 4> corners;  ///< ascending
  std::array<int, 2> tris;     ///< ascending
  Vec3 normal;
  bool operator<(const Quad& o) const { return std::tie(corners, tris) < std::tie(o.corners, o.tris); }
};

std::vector<Quad> find_quads(const Repair& r, const std::vector<Vec3>& points) {
  std::vector<Quad> quads;
  for (int h = 0; h < (int)r.opposite.size(); ++h) {
    const int g = r.opposite[h];
    if (g < h || origin(r.tris, h) == origin(r.tris, g)) continue;
    Quad q{{origin(r.tris, h), target(r.tris, h), origin(r.tris, prev(h)), origin(r.tris, prev(g))},
           {h / 3, g / 3},
           {}};
    if (std::none_of(q.corners.begin(), q.corners.end(), [&](int v) { return r.split[v]; })) continue;
    const Vec3 m = area_vector(r, points, h / 3), n = area_vector(r, points, g / 3);
    if (!(norm(m) > 0 && norm(n) > 0 && angle(m, n) < flat)) continue;
    q.normal = m + n;
    std::sort(q.corners.begin(), q.corners.end());
    quads.push_back(q);
  }
  std::sort(quads.begin(), quads.end());
  return quads;
}

enum Sheet : char { single, first, second };

/// Sets of triangles connected by edges of two, and of doubled ones connected by edges, in complexes of
/// triangles connected by edges.
struct Flaps {
  UnionFind flap, complex;
  std::vector<char> odd;      ///< per flap: an edge has an odd number of its triangles
  std::vector<char> rim;      ///< per flap: an edge has two of its triangles, one on the other, and no others
  std::vector<char> bounded;  ///< per flap: an edge has others too
  std::vector<char> open;     ///< per complex: not as many triangles run in either direction along every edge
};

Flaps find_flaps(const Repair& r, const std::vector<char>& sheet, const std::vector<char>& gone) {
  const int n = (int)r.tris.size();
  const std::vector<char> none(n, 0);
  Flaps f{UnionFind(n), UnionFind(n), none, none, none, none};
  std::vector<int> of;
  auto each_edge = [&](auto visit) {
    for_each_edge(r.tris, (int)r.vertex.size(), [&](std::span<const EdgeUse> uses) {
      of.clear();
      for (EdgeUse e : uses)
        if (!gone[half_edge(e) / 3]) of.push_back(half_edge(e));
      if (!of.empty()) visit();
    });
  };
  each_edge([&] {
    int last = -1, ascending = 0;
    for (int h : of) {
      f.complex.join(h / 3, of[0] / 3);
      ascending += origin(r.tris, h) < target(r.tris, h);
      if (of.size() != 2 && sheet[h / 3] == single) continue;
      if (last >= 0) f.flap.join(h / 3, last);
      last = h / 3;
    }
    if (2 * ascending != (int)of.size()) f.open[of[0] / 3] = 1;
  });
  for (int t = 0; t < n; ++t)
    if (f.open[t]) f.open[f.complex.find(t)] = 1;
  each_edge([&] {
    const bool ends = of.size() == 2 && (sheet[of[0] / 3] == single || sheet[of[0] / 3] != sheet[of[1] / 3]);
    for (int& h : of) h = f.flap.find(h / 3);
    std::sort(of.begin(), of.end());
    for (std::size_t i = 0, j; i < of.size(); i = j) {
      for (j = i; j < of.size() && of[j] == of[i];) ++j;
      f.odd[of[i]] |= (j - i) % 2;
      f.bounded[of[i]] |= j - i < of.size();
      f.rim[of[i]] |= ends && j - i == 2;
    }
  });
  return f;
}

/// Drops fins: closed sets of triangles that end freely, enclose nothing, whatever their diagonals, and are
/// too small to be meant, as intersecting bodies in rounded coordinates leaves them, or are one triangle and
/// its double, as coarsening does.
void drop_fins(const Repair& r, const std::vector<Vec3>& points, const std::vector<char>& sheet,
               std::vector<char>& gone) {
  constexpr double fin = 1e-6;    // of the area of all: the fins of bodies put together have 1e-7, or less
  constexpr double empty = 1e-3;  // of the area to the power 3/2: a cube has 0.07 as its volume
  const int n = (int)r.tris.size();
  Flaps f = find_flaps(r, sheet, gone);
  std::vector<double> area(n, 0), volume(n, 0);
  std::vector<int> size(n, 0);
  double whole = 0;
  for (int t = 0; t < n; ++t) {
    const Vec3 normal = area_vector(r, points, t);
    whole += norm(normal);
    if (gone[t]) continue;
    const int k = f.flap.find(t);
    area[k] += norm(normal);
    volume[k] += dot(point(r, points, r.tris[t][0]) - point(r, points, r.tris[k][0]), normal) / 3;
    ++size[k];
  }
  for (int t = 0; t < n; ++t) {
    const int k = f.flap.find(t);
    const bool small = area[k] < fin * whole && std::abs(volume[k]) < empty * std::pow(area[k], 1.5);
    if (f.rim[k] && f.bounded[k] && !f.odd[k] && (small || size[k] == 2)) gone[t] = 1;
  }
}

/// Drops the second sheets of contacts, except those that other triangles bound, in a complex of closed
/// solids.
void drop_other_contacts(const Repair& r, const std::vector<char>& sheet, std::vector<char>& gone) {
  Flaps f = find_flaps(r, sheet, gone);
  for (int t = 0; t < (int)r.tris.size(); ++t) {
    const int k = f.flap.find(t);
    if (sheet[t] == second && (f.open[f.complex.find(t)] || f.rim[k] || !f.bounded[k])) gone[t] = 1;
  }
}

}  // namespace

int drop_doubles(const Repair& r, const std::vector<Vec3>& points,
                 const std::vector<std::array<int, 2>>& same, CleanOptions::Sheets sheets,
                 std::vector<char>& gone) {
  const bool solids = sheets == CleanOptions::pair;
  std::vector<char> sheet(r.tris.size(), single);
  auto taken = [&](int t) { return gone[t] || sheet[t] != single; };
  for (const auto& [t, u] : same) {
    if (taken(u)) continue;
    if (!taken(t) && !same_orientation(r.tris[t], r.tris[u]))
      sheet[t] = first, sheet[u] = second;
    else
      gone[u] = 1;
  }
  if (sheets != CleanOptions::split) drop_fins(r, points, sheet, gone);
  if (!solids) {
    for (std::size_t t = 0; t < sheet.size(); ++t) gone[t] |= sheet[t] == second;
    sheet.assign(sheet.size(), single);
  }
  if (sheets == CleanOptions::split) return 0;
  const std::vector<Quad> quads = find_quads(r, points);
  for (std::size_t i = 1; i < quads.size(); ++i) {
    const Quad &q = quads[i - 1], &p = quads[i];
    // two of the three triangles around a vertex have all its neighbors as corners, whichever two
    auto free = [&](int t) { return !taken(t) && t != p.tris[0] && t != p.tris[1]; };
    if (q.corners != p.corners || !free(q.tris[0]) || !free(q.tris[1]) || taken(p.tris[0]) ||
        taken(p.tris[1]))
      continue;
    const double bend = angle(q.normal, p.normal);
    if (std::min(bend, std::numbers::pi - bend) > flat) continue;
    for (int k : {0, 1})
      if (bend > flat && solids)
        sheet[q.tris[k]] = first, sheet[p.tris[k]] = second;
      else
        gone[p.tris[k]] = 1;
  }
  if (std::find(sheet.begin(), sheet.end(), second) == sheet.end()) return 0;
  drop_other_contacts(r, sheet, gone);
  int kept = 0;
  for (std::size_t t = 0; t < sheet.size(); ++t) kept += sheet[t] == second && !gone[t];
  return kept;
}

}  // namespace meshpipe
