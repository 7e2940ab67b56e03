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

/// Contacts: sets of doubled triangles connected by edges, in complexes of triangles connected by edges.
struct Contacts {
  UnionFind complex, contact;
  std::vector<char> open;     ///< per complex: not as many triangles run in either direction along every edge
  std::vector<char> rim;      ///< per contact: both sheets end at an edge of no other triangle
  std::vector<char> bounded;  ///< per contact: other triangles are at its edges
};

Contacts find_contacts(const Repair& r, const std::vector<char>& sheet, const std::vector<char>& gone) {
  const int n = (int)r.tris.size();
  Contacts c{UnionFind(n), UnionFind(n), std::vector<char>(n, 0), std::vector<char>(n, 0), {}};
  c.bounded = c.rim;
  for_each_edge(r.tris, (int)r.vertex.size(), [&](std::span<const EdgeUse> uses) {
    int any = -1, last = -1, count = 0, doubled = 0, ascending = 0;
    bool both = false;
    for (EdgeUse e : uses) {
      const int h = half_edge(e), t = h / 3;
      if (gone[t]) continue;
      if (count++) c.complex.join(t, any);
      any = t;
      ascending += origin(r.tris, h) < target(r.tris, h);
      if (sheet[t] == single) continue;
      if (doubled++) {
        c.contact.join(t, last);
        both = both || sheet[t] != sheet[last];
      }
      last = t;
    }
    if (2 * ascending != count) c.open[any] = 1;
    if (doubled && doubled < count) c.bounded[last] = 1;
    if (count == 2 && both) c.rim[last] = 1;
  });
  for (int t = 0; t < n; ++t) {
    if (c.open[t]) c.open[c.complex.find(t)] = 1;
    if (c.rim[t]) c.rim[c.contact.find(t)] = 1;
    if (c.bounded[t]) c.bounded[c.contact.find(t)] = 1;
  }
  return c;
}

/// Drops both sheets of fins: contacts that end freely and are too small to be meant, as intersecting bodies
/// in rounded coordinates leaves them, or of one triangle, as coarsening does.
void drop_fins(const Repair& r, const std::vector<Vec3>& points, const std::vector<char>& sheet,
               std::vector<char>& gone) {
  constexpr double fin = 1e-6;  // of the area of all: the fins of bodies put together have 1e-8, or less
  if (std::find(sheet.begin(), sheet.end(), second) == sheet.end()) return;
  const int n = (int)r.tris.size();
  Contacts c = find_contacts(r, sheet, gone);
  std::vector<double> area(n, 0);
  std::vector<int> size(n, 0);
  double whole = 0;
  for (int t = 0; t < n; ++t) {
    const auto& [i, j, k] = r.tris[t];
    const double a = norm(area_vector(points[r.vertex[i]], points[r.vertex[j]], points[r.vertex[k]]));
    whole += a;
    if (gone[t] || sheet[t] == single) continue;
    area[c.contact.find(t)] += a;
    ++size[c.contact.find(t)];
  }
  for (int t = 0; t < n; ++t) {
    const int k = c.contact.find(t);
    const bool small = area[k] < fin * whole || size[k] == 2;
    if (sheet[t] != single && c.rim[k] && c.bounded[k] && small) gone[t] = 1;
  }
}

/// Drops the second sheets of contacts, except those that other triangles bound, in a complex of closed
/// solids.
void drop_other_contacts(const Repair& r, const std::vector<char>& sheet, std::vector<char>& gone) {
  Contacts c = find_contacts(r, sheet, gone);
  for (int t = 0; t < (int)r.tris.size(); ++t) {
    const int k = c.contact.find(t);
    if (sheet[t] == second && (c.open[c.complex.find(t)] || c.rim[k] || !c.bounded[k])) gone[t] = 1;
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
  drop_fins(r, points, sheet, gone);
  if (!solids) {
    for (std::size_t t = 0; t < sheet.size(); ++t) gone[t] |= sheet[t] == second;
    sheet.assign(sheet.size(), single);
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
