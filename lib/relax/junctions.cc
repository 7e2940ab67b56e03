// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/junctions.h"

#include <array>

#include "lib/core/weld.h"
#include "lib/relax/operations.h"

namespace meshpipe {
namespace {

/// The vertices before and after a border vertex along the border.
std::array<int, 2> along_border(const EditMesh& m, int v) {
  int last = 0;
  m.star(v, [&](int h) { last = h; });
  return {m.apex(last), m.to(m.out[v])};
}

bool is_copy(const State& s, int v, int w) {
  bool found = false;
  for_copies(s, v, [&](int c) { found |= c == w; });
  return found;
}

/// The border half-edges along the edge of h, that of h first. The vertex where sheets cease to meet has no
/// copies: both half-edges there are its own.
std::vector<int> edges_along(const State& s, int h) {
  const EditMesh& m = s.mesh;
  std::vector<int> edges{h};
  if (m.opp[h] >= 0 || s.copy.empty()) return edges;
  for_copies(s, m.from(h), [&](int v) {
    if (!m.on_border(v)) return;
    int last = 0;
    m.star(v, [&](int e) { last = e; });
    const int leaving = m.out[v], coming = prev(last);
    if (leaving != h && is_copy(s, m.to(h), m.to(leaving))) edges.push_back(leaving);
    if (coming != h && is_copy(s, m.to(h), m.from(coming))) edges.push_back(coming);
  });
  return edges;
}

bool near(const State& s, const Place& place, Vec3 p, int v) {
  return norm(s.reference->walk.point(place) - p) <= rules::same_place * s.target(v);
}

/// Splits an edge at the place on its sheet that is nearest to its middle, even if the pieces fold.
void split_anyway(State& s, int h) {
  const EditMesh& m = s.mesh;
  const SurfaceWalk& walk = s.reference->walk;
  const Vec3 middle = lerp(s.points[m.from(h)], s.points[m.to(h)], 0.5);
  Place best;
  double least = 1e300;
  for (int v : {m.from(h), m.to(h), m.apex(h), m.apex(m.opp[h])}) {
    const Place place = walk.closest(s.place[v], middle);
    if (const double d = norm(walk.point(place) - middle); d < least) least = d, best = place;
  }
  insert_vertex(s, h, best, walk.point(best), s.reference->normal(best));
}

}  // namespace

void share_vertices(State& s) {
  const int n = (int)s.points.size();
  std::vector<char> border(n, 0);
  for (int v = 0; v < n; ++v) border[v] = s.mesh.out[v] >= 0 && s.mesh.on_border(v);
  const std::vector<int> first = first_equal(s.points, border);
  s.copy.resize(n);
  for (int v = 0; v < n; ++v) {
    s.copy[v] = v;
    if (first[v] != v) s.copy[v] = std::exchange(s.copy[first[v]], v);
  }
  auto line = [&](int v) {
    const auto [a, b] = along_border(s.mesh, v);
    return std::array{std::min(first[a], first[b]), std::max(first[a], first[b])};
  };
  for (int v = 0; v < n; ++v) {
    if (first[v] != v || !is_shared(s, v)) continue;
    bool held = false;
    for_copies(s, v, [&](int c) { held |= s.hold[c] != slides || line(c) != line(v); });
    if (held) for_copies(s, v, [&](int c) { s.hold[c] = fixed; });
  }
}

std::vector<CopyPlace> copies_at(const State& s, int v, const Place& place, Vec3 p) {
  std::vector<CopyPlace> places;
  bool all = true;
  for_copies(s, v, [&](int c) {
    const Place at = c == v ? place : s.reference->walk.slide(s.place[c], p);
    all &= c == v || near(s, at, p, c);
    const bool two_normals = s.hold[v] == slides && !s.mesh.on_border(c);
    places.push_back({c, at, two_normals ? Vec3{} : s.reference->normal(at)});
  });
  if (!all) places.clear();
  return places;
}

std::vector<CopyPlace> places_on_edge(const State& s, int h, const Place& place, Vec3 p) {
  const EditMesh& m = s.mesh;
  const bool two_normals = m.hard[h] && m.opp[h] >= 0;
  std::vector<CopyPlace> places{{h, place, two_normals ? Vec3{} : s.reference->normal(place)}};
  for (int e : edges_along(s, h)) {
    if (e == h) continue;
    const int from = end_on_line(s, m.from(e), m.to(e));
    const SurfaceWalk& walk = s.reference->walk;
    const Place at =
        from < 0 ? walk.slide(s.place[m.from(e)], s.place[m.to(e)], p) : walk.slide(s.place[from], p);
    if (!near(s, at, p, m.from(e))) return {};
    places.push_back({e, at, s.reference->normal(at)});
  }
  return places;
}

void insert_copies(State& s, const std::vector<CopyPlace>& edges, Vec3 p) {
  const int first = (int)s.points.size(), n = (int)edges.size();
  for (const CopyPlace& e : edges) insert_vertex(s, e.at, e.place, p, e.normal);
  for (int i = 0; i < n && n > 1; ++i) s.copy[first + i] = first + (i + 1) % n;
}

std::vector<std::pair<int, int>> with_copies(const State& s, int h, int gone) {
  std::vector<std::pair<int, int>> edges;
  std::size_t copies = 0;
  for (int e : edges_along(s, h)) {
    const int a = s.mesh.from(e);
    edges.push_back({e, is_copy(s, gone, a) ? a : s.mesh.to(e)});
  }
  for_copies(s, gone, [&](int) { ++copies; });
  if (edges.size() != copies) edges.clear();
  return edges;
}

bool joined_elsewhere(const State& s, int a, int b) {
  if (!is_shared(s, a) && !is_shared(s, b)) return false;
  bool joined = false;
  for_copies(s, a, [&](int v) {
    for_copies(s, b, [&](int w) { joined = joined || ((v != a || w != b) && s.mesh.joined(v, w)); });
  });
  return joined;
}

bool doubles_edges(const State& s, int h, int gone) {
  const EditMesh& m = s.mesh;
  const int kept = m.from(h) == gone ? m.to(h) : m.from(h), g = m.opp[h];
  if (s.copy.empty()) return false;
  const int c = m.apex(h), d = g < 0 ? -1 : m.apex(g);
  bool doubles = false;
  m.neighbors(gone, [&](int v) {
    doubles = doubles || (v != kept && v != c && v != d && joined_elsewhere(s, kept, v));
  });
  return doubles;
}

void part_double_edges(State& s) {
  const EditMesh& m = s.mesh;
  if (s.copy.empty()) return;
  for (int h = 0; h < (int)m.opp.size(); ++h) {
    if (h < m.opp[h] || m.opp[h] < 0 || !joined_elsewhere(s, m.from(h), m.to(h))) continue;
    if (may_flip(s, h))
      flip_edge(s, h);
    else if (!split_edge(s, h))
      split_anyway(s, h);
  }
}

void extract_copies(const State& s, const std::vector<int>& triangles, const std::vector<int>& vertices,
                    State& patch) {
  const int n = (int)vertices.size();
  patch.copy.resize(n);
  for (int i = 0; i < n; ++i) {
    patch.copy[i] = i;
    bool found = false;
    int w = vertices[i];
    while (!found) {
      w = s.copy[w];
      const auto at = std::lower_bound(vertices.begin(), vertices.end(), w);
      found = at != vertices.end() && *at == w;
      if (found) patch.copy[i] = (int)(at - vertices.begin());
      if (!found) patch.hold[i] = frozen;
    }
  }
  const EditMesh& m = patch.mesh;
  for (int h = 0; h < (int)m.opp.size(); ++h) {
    const int whole = 3 * triangles[h / 3] + h % 3;
    if (s.mesh.opp[whole] < 0 && edges_along(patch, h).size() < edges_along(s, whole).size())
      patch.hold[m.from(h)] = patch.hold[m.to(h)] = frozen;
  }
  for (int i = 0; i < n; ++i)
    if (patch.hold[i] == frozen) for_copies(patch, i, [&](int c) { patch.hold[c] = frozen; });
}

}  // namespace meshpipe
