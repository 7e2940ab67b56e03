// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/model_edges.h"

#include <algorithm>

#include "lib/core/bvh.h"
#include "lib/core/topology.h"

namespace meshpipe {

std::vector<int> segments_under(const Mesh& mesh, const ModelSegments& segments) {
  std::vector<int> under(3 * mesh.tris.size(), -1);
  if (segments.tris.empty()) return under;
  const Bvh tree(segments);
  const double tolerance = 1e-6 * diagonal(mesh);
  auto nearest = [&](Vec3 p) {
    const Bvh::Hit hit = tree.nearest(p);
    return hit.distance <= tolerance ? hit.place.face : -1;
  };
  std::vector<char> on(mesh.points.size());
  for (std::size_t v = 0; v < on.size(); ++v) on[v] = nearest(mesh.points[v]) >= 0;
  for (int h = 0; h < (int)under.size(); ++h) {
    const int a = origin(mesh.tris, h), b = target(mesh.tris, h);
    // the same point for both half-edges
    if (on[a] && on[b])
      under[h] = nearest(lerp(mesh.points[std::min(a, b)], mesh.points[std::max(a, b)], 0.5));
  }
  return under;
}

ModelSegments moved_segments(const ModelSegments& segments, const std::vector<int>& under, const Mesh& after,
                             const std::vector<int>& under_after) {
  ModelSegments moved;
  auto add = [&](int i, Vec3 a, Vec3 b) {
    const int n = (int)moved.points.size();
    moved.points.insert(moved.points.end(), {a, b});
    moved.tris.push_back({n, n + 1, n + 1});
    moved.tag.push_back(segments.tag[i]);
    moved.ridge.push_back(segments.ridge[i]);
    moved.required.push_back(segments.required[i]);
  };
  std::vector<char> used(segments.tris.size(), 0);
  for (int i : under)
    if (i >= 0) used[i] = 1;
  for (int i = 0; i < (int)used.size(); ++i)
    if (!used[i]) add(i, segments.points[segments.tris[i][0]], segments.points[segments.tris[i][1]]);
  std::vector<std::pair<int, int>> ascending;
  for (int h = 0; h < (int)under_after.size(); ++h)
    if (const int a = origin(after.tris, h), b = target(after.tris, h); under_after[h] >= 0 && a < b)
      ascending.push_back({a, b});
  std::sort(ascending.begin(), ascending.end());
  for (int h = 0; h < (int)under_after.size(); ++h) {
    const int a = origin(after.tris, h), b = target(after.tris, h);
    if (under_after[h] < 0) continue;
    // of a border there may only be the half-edge that descends
    if (a < b || !std::binary_search(ascending.begin(), ascending.end(), std::pair{b, a}))
      add(under_after[h], after.points[a], after.points[b]);
  }
  return moved;
}

ModelSegments segments_after_ends(const ModelSegments& segments, const Mesh& before, const Mesh& after) {
  auto same = [](Tri a, Tri b) {
    std::sort(a.begin(), a.end()), std::sort(b.begin(), b.end());
    return a == b;
  };
  const std::vector<int> under = segments_under(before, segments);
  if (before.tris.size() <= after.tris.size() &&
      std::equal(before.tris.begin(), before.tris.end(), after.tris.begin(), same))
    return moved_segments(segments, under, {after.points, before.tris}, under);
  const std::vector<int> opposite = opposite_halfedges(before);
  std::vector<char> gone(segments.tris.size(), 0);
  for (int h = 0; h < (int)under.size(); ++h)
    if (under[h] >= 0 && opposite[h] < 0) gone[under[h]] = 1;
  for (int s : segments_under(after, segments))
    if (s >= 0) gone[s] = 0;
  ModelSegments kept;
  kept.points = segments.points;
  for (int i = 0; i < (int)gone.size(); ++i) {
    if (gone[i]) continue;
    kept.tris.push_back(segments.tris[i]);
    kept.tag.push_back(segments.tag[i]);
    kept.ridge.push_back(segments.ridge[i]);
    kept.required.push_back(segments.required[i]);
  }
  return kept;
}

}  // namespace meshpipe
