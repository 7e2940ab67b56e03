// SPDX-License-Identifier: BSD-3-Clause
#include "lib/resolve/simplify.h"

#include "lib/core/edges.h"
#include "lib/core/intersect.h"
#include "lib/core/lists.h"
#include "lib/core/spatial_order.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

/// Replaces vertices by `same`, drops what has no area then, unites what coincides, and numbers vertices
/// anew; `flagged` follows.
void contract(PieceMesh& mesh, const std::vector<int>& same, std::vector<char>& flagged) {
  Pieces& p = mesh.pieces;
  int n = 0;
  for (std::size_t t = 0; t < p.tris.size(); ++t) {
    Tri tri = p.tris[t];
    for (int& v : tri) v = same[v];
    if (!has_area(mesh.points[tri[0]], mesh.points[tri[1]], mesh.points[tri[2]])) continue;
    p.tris[n] = tri;
    p.origin[n] = p.origin[t];
    p.weight[n++] = p.weight[t];
  }
  p.tris.resize(n);
  p.origin.resize(n);
  p.weight.resize(n);
  p.piece_of.clear();
  unite_coincident(p);
  const std::vector<int> vertex = number_by_first_use(p.tris, mesh.points.size());
  mesh.points = rearranged(mesh.points, vertex);
  flagged = rearranged(flagged, vertex);
}

/// Divides the long edges of flat triangles at their third vertices, at most one for each triangle that
/// changes. Returns whether there were any.
bool divide_edges(PieceMesh& mesh, const std::vector<char>& flagged, double tolerance) {
  Pieces& p = mesh.pieces;
  const auto& points = mesh.points;
  // the half-edge of a flat triangle that its third vertex lies on, or -1
  auto long_edge = [&](int t) {
    const Tri& v = p.tris[t];
    if (!flagged[v[0]] && !flagged[v[1]] && !flagged[v[2]]) return -1;
    int longest = 0;
    double length[3];
    for (int i = 0; i < 3; ++i) {
      length[i] = norm(points[v[(i + 1) % 3]] - points[v[i]]);
      if (length[i] > length[longest]) longest = i;
    }
    const double twice = norm(area_vector(points[v[0]], points[v[1]], points[v[2]]));
    return twice <= tolerance * length[longest] ? 3 * t + longest : -1;
  };
  std::vector<int> apex(3 * p.tris.size(), -1);  // per half-edge: the vertex to divide it at
  std::vector<char> taken(p.tris.size(), 0);
  bool any = false;
  for_each_edge(p.tris, (int)points.size(), [&](std::span<const EdgeUse> uses) {
    int at = -1;
    for (EdgeUse e : uses) {
      const int h = half_edge(e);
      if (taken[h / 3]) return;
      if (at < 0 && long_edge(h / 3) == h) at = origin(p.tris, prev(h));
    }
    if (at < 0) return;
    any = true;
    for (EdgeUse e : uses) taken[half_edge(e) / 3] = 1, apex[half_edge(e)] = at;
  });
  for (int h = 0, n = (int)apex.size(); h < n; ++h) {
    if (apex[h] < 0) continue;
    const int t = h / 3, i = h % 3;
    Tri second = p.tris[t];
    second[i] = apex[h];
    p.tris[t][(i + 1) % 3] = apex[h];  // a triangle of zero area with a vertex twice goes
    p.tris.push_back(second);
    p.origin.push_back(p.origin[t]);
    p.weight.push_back(p.weight[t]);
  }
  return any;
}

}  // namespace

void normalize(PieceMesh& mesh) {
  std::vector<char> none(mesh.points.size(), 0);
  contract(mesh, first_equal(mesh.points, std::vector<char>(mesh.points.size(), 1)), none);
}

void remove_slivers(PieceMesh& mesh, const std::vector<char>& flagged, double tolerance) {
  constexpr int most_rounds = 30;  // each divides every edge once at most
  std::vector<char> ring = flagged;
  for (const Tri& t : mesh.pieces.tris)
    if (flagged[t[0]] || flagged[t[1]] || flagged[t[2]])
      for (int v : t) ring[v] = 1;
  std::vector<int> same = identity(mesh.points.size());
  merge_near(mesh.points, ring, tolerance, same);
  contract(mesh, same, ring);
  for (int round = 0; round < most_rounds && divide_edges(mesh, ring, tolerance); ++round)
    contract(mesh, identity(mesh.points.size()), ring);
}

}  // namespace meshpipe
