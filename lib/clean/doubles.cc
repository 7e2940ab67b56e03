// SPDX-License-Identifier: BSD-3-Clause
// Triangles that lie on others: second copies of a sheet, and contacts between two solids.
#include <algorithm>
#include <array>
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
  auto normal = [&](int t) {
    auto p = [&](int i) { return points[r.vertex[r.tris[t][i]]]; };
    return area_vector(p(0), p(1), p(2));
  };
  for (int h = 0; h < (int)r.opposite.size(); ++h) {
    const int g = r.opposite[h];
    if (g < h || origin(r.tris, h) == origin(r.tris, g)) continue;
    Quad q{{origin(r.tris, h), target(r.tris, h), origin(r.tris, prev(h)), origin(r.tris, prev(g))},
           {h / 3, g / 3},
           {}};
    if (std::none_of(q.corners.begin(), q.corners.end(), [&](int v) { return r.split[v]; })) continue;
    const Vec3 m = normal(h / 3), n = normal(g / 3);
    if (!(norm(m) > 0 && norm(n) > 0 && angle(m, n) < flat)) continue;
    q.normal = m + n;
    std::sort(q.corners.begin(), q.corners.end());
    quads.push_back(q);
  }
  std::sort(quads.begin(), quads.end());
  return quads;
}

enum Sheet : char { single, first, second };

/// Drops the second sheets of contacts, except those that other triangles bound, in a complex of closed
/// solids: as many triangles run in either direction along every edge.
void drop_other_contacts(const Repair& r, const std::vector<char>& sheet, std::vector<char>& gone) {
  const int n = (int)r.tris.size();
  UnionFind complex(n), contact(n);
  std::vector<char> open(n, 0), rim(n, 0), bounded(n, 0);  // first by one triangle of an edge, then by set
  for_each_edge(r.tris, (int)r.vertex.size(), [&](std::span<const EdgeUse> uses) {
    int any = -1, last = -1, count = 0, doubled = 0, ascending = 0;
    bool both = false;
    for (EdgeUse e : uses) {
      const int h = half_edge(e), t = h / 3;
      if (gone[t]) continue;
      if (count++) complex.join(t, any);
      any = t;
      ascending += origin(r.tris, h) < target(r.tris, h);
      if (sheet[t] == single) continue;
      if (doubled++) {
        contact.join(t, last);
        both = both || sheet[t] != sheet[last];
      }
      last = t;
    }
    if (2 * ascending != count) open[any] = 1;
    if (doubled && doubled < count) bounded[last] = 1;
    if (count == 2 && both) rim[last] = 1;
  });
  for (int t = 0; t < n; ++t) {
    if (open[t]) open[complex.find(t)] = 1;
    if (rim[t]) rim[contact.find(t)] = 1;
    if (bounded[t]) bounded[contact.find(t)] = 1;
  }
  for (int t = 0; t < n; ++t) {
    const int c = contact.find(t);
    if (sheet[t] == second && (open[complex.find(t)] || rim[c] || !bounded[c])) gone[t] = 1;
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
    if (solids && !taken(t) && !same_orientation(r.tris[t], r.tris[u]))
      sheet[t] = first, sheet[u] = second;
    else
      gone[u] = 1;
  }
  if (sheets == CleanOptions::split) return 0;
  const std::vector<Quad> quads = find_quads(r, points);
  for (std::size_t i = 1; i < quads.size(); ++i) {
    const Quad &q = quads[i - 1], &p = quads[i];
    // two of the three triangles around a vertex have all its neighbors as corners, whichever two
    const bool overlap =
        q.tris[0] == p.tris[0] || q.tris[0] == p.tris[1] || q.tris[1] == p.tris[0] || q.tris[1] == p.tris[1];
    if (overlap || q.corners != p.corners || taken(q.tris[0]) || taken(q.tris[1]) || taken(p.tris[0]) ||
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
