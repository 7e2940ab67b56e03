// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/model_edges.h"

#include "lib/core/bvh.h"

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
  for (int h = 0; h < static_cast<int>(under.size()); ++h) {
    const int a = origin(mesh.tris, h), b = target(mesh.tris, h);
    // the same point for both half-edges
    if (on[a] && on[b])
      under[h] = nearest(lerp(mesh.points[std::min(a, b)], mesh.points[std::max(a, b)], 0.5));
  }
  return under;
}

}  // namespace meshpipe
