// SPDX-License-Identifier: BSD-3-Clause
// Loose fragments of a torn surface, which show nothing that the rest does not.
#include "lib/core/farthest.h"
#include "lib/core/topology.h"
#include "lib/defeature/zipper.h"

namespace meshpipe {
namespace {

constexpr int most_triangles = 256;  ///< of a fragment
constexpr double least_share = 0.1;  ///< of the tolerance: smaller distances count as this

/// How far a triangle is from those that are not left out, at most; infinite if that is not known.
double most_distance(const Surface& s, int t, const Bvh& tree, const std::vector<char>& left_out,
                     double least) {
  auto nearest = [&](Vec3 p) { return tree.nearest_but(left_out, p, infinity, 0); };
  Piece whole;
  double most = least;
  for (int i = 0; i < 3; ++i) {
    whole.corner[i] = s.points[s.tris[t][i]];
    const Bvh::Hit hit = nearest(whole.corner[i]);
    whole.face[i] = hit.place.face, whole.distance[i] = hit.distance;
    most = std::max(most, hit.distance);
  }
  const Farthest found = farthest(
      whole, s, [&](int) { return most; }, nearest);
  return found.complete ? std::max(most, farther_by * found.hit.distance) : infinity;
}

}  // namespace

std::vector<RemovedFeature> remove_fragments(const Surface& s, const DefeatureOptions& options, EditMesh& m,
                                             std::vector<double>& drift) {
  std::vector<int> component;
  const int n = components(m.opp, component);
  std::vector<std::vector<int>> triangles(n);  // the first of each
  std::vector<char> open(n, 0), kept(n, 0), loose(s.tris.size(), 0);
  std::vector<double> area(n, 0);
  for (int t = 0; t < (int)s.tris.size(); ++t) {
    const int c = component[t];
    if ((int)triangles[c].size() <= most_triangles) triangles[c].push_back(t);
    for (int h = 3 * t; h < 3 * t + 3; ++h) open[c] |= m.opp[h] < 0;
    kept[c] |= !options.kept.empty() && options.kept[t];
    area[c] += triangle_area(s, t);
  }
  kept[std::max_element(area.begin(), area.end()) - area.begin()] = 1;
  bool any = false;
  for (int c = 0; c < n; ++c) {
    if (!open[c] || kept[c] || (int)triangles[c].size() > most_triangles) triangles[c].clear();
    for (int t : triangles[c]) loose[t] = 1, any = true;
  }
  std::vector<RemovedFeature> removed;
  if (!any) return removed;
  const Bvh tree(s);
  for (const std::vector<int>& fragment : triangles) {
    if (fragment.empty()) continue;
    double most = 0;
    Box box = box_of(s, fragment[0]);
    for (int t : fragment) {
      most = std::max(most, most_distance(s, t, tree, loose, least_share * options.tolerance));
      if (most > options.tolerance) break;
      box = join(box, box_of(s, t));
    }
    if (most > options.tolerance) continue;
    removed.push_back({s.points[s.tris[fragment[0]][0]], most, norm(box.hi - box.lo)});
    const Vec3 reach{most, most, most};
    tree.overlapping({box.lo - reach, box.hi + reach}, [&](int t) {
      for (int v : s.tris[t]) drift[v] = std::max(drift[v], most);
    });
    for (int t : fragment) {
      for (int h = 3 * t; h < 3 * t + 3; ++h) m.hard[h] = 0, m.out[m.from(h)] = -1;
      m.tris[t] = {-1, -1, -1}, --m.live;
    }
  }
  return removed;
}

}  // namespace meshpipe
