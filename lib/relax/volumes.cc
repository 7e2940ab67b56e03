// SPDX-License-Identifier: BSD-3-Clause
// Volumes of regions: vertices on a curved reference have chords between them that cut off some of each.
#include "lib/relax/volumes.h"

#include <algorithm>
#include <cmath>

#include "lib/core/intersect.h"
#include "lib/core/junctions.h"
#include "lib/core/normals.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

constexpr double off_reference = 0.08;  // of the shortest edge at a vertex; mcheck permits 0.1
constexpr double exact = 1e-9;          // relative difference of volumes that rounding leaves
constexpr int tries = 4;                // to move back what intersects

/// The regions on both sides of each triangle by their row among `regions`, 0 of what is not in a region.
std::vector<std::array<int, 2>> sides_of(const std::vector<int>& patch, const std::vector<SheetPatch>& sheets,
                                         const std::vector<RegionMeasure>& regions) {
  std::vector<std::array<int, 2>> sides;
  for (int p : patch) {
    const SheetPatch* s = find_sheet(sheets, p);
    sides.push_back(s ? std::array{row_of(regions, s->front) + 1, row_of(regions, s->back) + 1}
                      : std::array{0, 0});
  }
  return sides;
}

/// Vertices inside of sheets give way by the sagitta of their edges, so that plane sheets stay plane; those
/// on borders and model edges stay.
Compliance compliance_of(const LiftedMesh& mesh) {
  const int n = (int)mesh.points.size();
  Compliance c{std::vector<double>(n, 0), std::vector<double>(n, 1e300)};
  const std::vector<Vec3> normal = vertex_normals(mesh);
  std::vector<int> count(n, 0);
  std::vector<char> stays(n, 0);
  const std::vector<int> opposite = opposite_halfedges(mesh.tris, n);
  for (int h = 0; h < (int)opposite.size(); ++h) {
    const int a = origin(mesh.tris, h), b = target(mesh.tris, h);
    if (opposite[h] < 0 || (mesh.model[h / 3] >> h % 3 & 1)) stays[a] = stays[b] = 1;
    const Vec3 edge = mesh.points[b] - mesh.points[a];
    c.share[a] += std::abs(dot(edge, normal[a]));
    c.farthest[a] = std::min(c.farthest[a], off_reference * norm(edge));
    ++count[a];
  }
  for (int v = 0; v < n; ++v) {
    c.share[v] = stays[v] || mesh.kind[v] == 2 || count[v] == 0 ? 0 : c.share[v] / count[v];
    if (c.share[v] < exact * c.farthest[v]) c.share[v] = 0;
  }
  return c;
}

}  // namespace

double keep_volumes(LiftedMesh& mesh, const Surface& reference, const std::vector<SheetPatch>& sheets) {
  std::vector<RegionMeasure> regions = measure_regions(reference, sheets);
  std::erase_if(regions, [](const RegionMeasure& r) { return r.label <= 0; });
  const std::vector<std::array<int, 2>> sides = sides_of(mesh.patch, sheets, regions);
  std::vector<double> volume{0};
  for (const RegionMeasure& r : regions) volume.push_back(r.volume);
  Compliance compliance = compliance_of(mesh);
  Mesh joined = mesh;
  const std::vector<int> was = join_borders(joined);
  for (auto* column : {&compliance.share, &compliance.farthest}) {
    std::vector<double> of_joined;
    for (int v : was) of_joined.push_back((*column)[v]);
    *column = std::move(of_joined);
  }
  const Mesh start = joined;
  std::vector<std::pair<int, int>> before;
  for (int i = 0; i < tries; ++i) {
    joined.points = start.points;
    const double left = match_volumes(joined, sides, volume, compliance);
    if (i == 0) before = self_intersections(start);
    bool moved_back = false;
    for (const std::pair<int, int>& pair : self_intersections(joined)) {
      if (std::binary_search(before.begin(), before.end(), pair)) continue;
      moved_back = true;
      for (int t : {pair.first, pair.second})
        for (int v : joined.tris[t]) compliance.share[v] = 0;
    }
    if (moved_back) continue;
    for (std::size_t t = 0; t < mesh.tris.size(); ++t)
      for (int k : {0, 1, 2}) mesh.points[mesh.tris[t][k]] = joined.points[joined.tris[t][k]];
    return left;
  }
  for (double& share : compliance.share) share = 0;
  return match_volumes(joined = start, sides, volume, compliance);
}

}  // namespace meshpipe
