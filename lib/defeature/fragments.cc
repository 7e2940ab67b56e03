// SPDX-License-Identifier: BSD-3-Clause
// Loose fragments of a torn surface, which show nothing that the rest does not.
#include "lib/core/boxes.h"
#include "lib/core/farthest.h"
#include "lib/core/topology.h"
#include "lib/defeature/zipper.h"

namespace meshpipe {
namespace {

constexpr int largest_fragment = 256;  ///< of a fragment
constexpr double least_share = 0.1;    ///< of the tolerance: smaller distances count as this
constexpr double around = 1.1;         ///< of the distance of corners: what is tried before the tolerance
/// Halvings that the search for the farthest point may take, in one triangle and in all.
constexpr int most_halvings = 2000, halvings_per_triangle = 20, halvings_at_least = 100000;

/// What stays of a surface for certain, with the rows of its vertices in that.
struct Rest {
  Rest(const Surface& s, const std::vector<int>& triangles)
      : mesh(part_of(s, triangles, &vertices)),
        tree(mesh),
        halvings(halvings_at_least + (long)halvings_per_triangle * (long)s.tris.size()) {}

  std::vector<int> vertices;
  Mesh mesh;
  Bvh tree;
  long halvings;  ///< left
};

/// Is the fragment within `limit` of the rest, as far as the halvings last? `width` grows to the distance
/// seen.
bool is_within(const std::vector<Piece>& fragment, double limit, Rest& rest, double& width) {
  auto nearest = [&](Vec3 p) { return rest.tree.nearest(p); };
  for (const Piece& piece : fragment) {
    const Farthest found = farthest(
        piece, rest.mesh, [&](int) { return limit; }, nearest,
        (int)std::min<long>(most_halvings, rest.halvings));
    rest.halvings -= found.halvings;
    if (found.halvings > 0) width = std::max(width, found.hit.distance);
    if (!found.complete || width > limit) return false;
  }
  return true;
}

/// Returns what no point of these triangles is farther from the rest than, and the distance seen; infinity if
/// they are not known to be within the tolerance.
double most_distance(const Surface& s, const std::vector<int>& triangles, double tolerance, Rest& rest,
                     double& width) {
  std::vector<Piece> fragment;
  width = 0;
  for (int t : triangles) {
    Piece& piece = fragment.emplace_back();
    for (int i = 0; i < 3; ++i) {
      piece.corner[i] = s.points[s.tris[t][i]];
      const Bvh::Hit hit = rest.tree.nearest_within(piece.corner[i], tolerance, 0);
      if (hit.place.face < 0) return infinity;
      piece.face[i] = hit.place.face, piece.distance[i] = hit.distance;
      width = std::max(width, hit.distance);
    }
  }
  for (const double limit : {std::max(least_share * tolerance, around * width), tolerance})
    if (limit <= tolerance && is_within(fragment, limit, rest, width)) return limit;
  return infinity;
}

}  // namespace

std::vector<RemovedFeature> remove_fragments(const Surface& s, const DefeatureOptions& options, EditMesh& m,
                                             std::vector<double>& drift) {
  if (small_regions(m, largest_fragment, [&](int h) { return m.opp[h] < 0; }).empty()) return {};
  std::vector<int> component;
  const int n = components(m.opp, component);
  std::vector<std::vector<int>> triangles(n);  // the first of each
  std::vector<char> open(n, 0), kept(n, 0), loose(s.tris.size(), 0);
  std::vector<double> area(n, 0);
  for (int t = 0; t < (int)s.tris.size(); ++t) {
    const int c = component[t];
    if ((int)triangles[c].size() <= largest_fragment) triangles[c].push_back(t);
    for (int h = 3 * t; h < 3 * t + 3; ++h) open[c] |= m.opp[h] < 0;
    kept[c] |= !options.kept.empty() && options.kept[t];
    area[c] += triangle_area(s, t);
  }
  kept[std::max_element(area.begin(), area.end()) - area.begin()] = 1;
  bool any = false;
  for (int c = 0; c < n; ++c) {
    if (!open[c] || kept[c] || (int)triangles[c].size() > largest_fragment) triangles[c].clear();
    for (int t : triangles[c]) loose[t] = 1, any = true;
  }
  std::vector<RemovedFeature> removed;
  if (!any) return removed;
  std::vector<int> rows;
  for (int t = 0; t < (int)loose.size(); ++t)
    if (!loose[t]) rows.push_back(t);
  Rest rest(s, rows);
  for (const std::vector<int>& fragment : triangles) {
    if (fragment.empty()) continue;
    double width = 0;
    const double most = most_distance(s, fragment, options.tolerance, rest, width);
    if (most > options.tolerance) continue;
    Box box = box_of(s, fragment[0]);
    for (int t : fragment) {
      const Box at = box_of(s, t);
      box = join(box, at);
      const Vec3 reach{most, most, most};
      rest.tree.overlapping({at.lo - reach, at.hi + reach}, [&](int u) {
        for (int v : rest.mesh.tris[u]) drift[rest.vertices[v]] = std::max(drift[rest.vertices[v]], most);
      });
    }
    removed.push_back({s.points[s.tris[fragment[0]][0]], width, norm(box.hi - box.lo)});
    for (int t : fragment) {
      for (int h = 3 * t; h < 3 * t + 3; ++h) m.hard[h] = 0, m.out[m.from(h)] = -1;
      m.tris[t] = {-1, -1, -1}, --m.live;
    }
  }
  return removed;
}

}  // namespace meshpipe
