// SPDX-License-Identifier: BSD-3-Clause
// Regions between lines that are smaller than the tolerance.
#include <algorithm>
#include <numbers>

#include "lib/core/bvh.h"
#include "lib/defeature/zipper.h"

namespace meshpipe {
namespace {

constexpr int largest_region = 256;  ///< of a region: fine meshes of no feature are not searched
/// Length of the mean unit normal around a region, at least: 1 in a plane, 0 around the end of a thin rod,
/// which would become a needle.
constexpr double least_mean = 0.25;

/// The triangles connected with t without crossing a hard edge.
std::vector<int> region_of(const EditMesh& mesh, int t, std::vector<char>& seen) {
  std::vector<int> region{t};
  seen[t] = 1;
  for (std::size_t i = 0; i < region.size(); ++i)
    for (int h = 3 * region[i]; h < 3 * region[i] + 3; ++h) {
      const int o = mesh.opp[h];
      if (mesh.hard[h] || seen[o / 3]) continue;
      seen[o / 3] = 1;
      region.push_back(o / 3);
    }
  return region;
}

constexpr double least_angle = std::numbers::pi / 2;  ///< around a vertex
constexpr int most_vertices = 512;                    ///< in a ball
constexpr int least_corners = 3;                      ///< two are the ends of a short line

}  // namespace

/// The vertices joined to the center by edges of vertices within half the tolerance; none if they are too
/// many.
std::vector<int> Zipper::ball(int center) const {
  std::vector<int> found{center};
  for (std::size_t i = 0; i < found.size() && (int)found.size() <= most_vertices; ++i)
    mesh.neighbors(found[i], [&](int v) {
      if (norm(points[v] - points[center]) > options_.tolerance / 2) return;
      if (std::find(found.begin(), found.end(), v) == found.end()) found.push_back(v);
    });
  if ((int)found.size() > most_vertices) found.clear();
  return found;
}

/// Would the contraction of these vertices make a needle: a spike, as of the end of a rod, or a strip that
/// tapers to nothing, as at the corner of a thin plate?
bool Zipper::makes_needle(const std::vector<int>& vertices) const {
  const Vec3 at = points[vertices[0]];
  auto inside = [&](int v) { return std::find(vertices.begin(), vertices.end(), v) != vertices.end(); };
  double whole_angle = 0;
  bool found = false;
  for (int v : vertices)
    mesh.star(v, [&](int h) {
      const bool to = inside(mesh.to(h)), apex = inside(mesh.apex(h));
      if (!to && !apex) whole_angle += angle(points[mesh.to(h)] - at, points[mesh.apex(h)] - at);
      const Side s = to ? side_of(h) : Side();
      found |= s.parallel() && folded(s) && norm(s.along_a) > options_.tolerance &&
               norm(s.along_b) > options_.tolerance;
    });
  return found || whole_angle < least_angle;
}

int Zipper::contract_clusters() {
  std::fill(region_.begin(), region_.end(), -1);
  std::vector<std::vector<int>> balls;
  std::vector<std::array<int, 2>> order;  // most corners first
  const std::vector<char> on_line = vertices_on_lines();
  for (int v = 0; v < (int)points.size(); ++v) {
    if (!on_line[v] || !is_corner(v)) continue;
    std::vector<int> found = ball(v);
    const int corners = (int)std::count_if(found.begin(), found.end(), [&](int w) { return is_corner(w); });
    if (corners < least_corners || makes_needle(found)) continue;
    order.push_back({-corners, (int)balls.size()});
    balls.push_back(std::move(found));
  }
  std::sort(order.begin(), order.end());
  std::vector<Candidate> heap;
  for (const auto& [corners, i] : order) {
    if (std::any_of(balls[i].begin(), balls[i].end(), [&](int v) { return region_[v] >= 0; })) continue;
    for (int v : balls[i]) region_[v] = i;
    for (int v : balls[i]) mesh.star(v, [&](int h) { consider(heap, h / 3); });
  }
  return run(std::move(heap));
}

int Zipper::contract_regions() {
  std::fill(region_.begin(), region_.end(), -1);
  std::vector<char> seen(mesh.tris.size(), 0);
  std::vector<Candidate> heap;
  int n = 0;
  for (int t : small_regions(mesh, largest_region, [&](int h) { return mesh.hard[h] != 0; })) {
    const std::vector<int> region = region_of(mesh, t, seen);
    std::vector<int> vertices;
    Vec3 low = points[mesh.tris[t][0]], high = low, mean;
    double around = 0;
    int edges = 0;
    for (int u : region)
      for (int h = 3 * u; h < 3 * u + 3; ++h) {
        const int v = mesh.from(h), o = mesh.opp[h];
        vertices.push_back(v);
        low = lower(low, points[v]), high = upper(high, points[v]);
        edges += mesh.hard[h] ? 2 : 1;
        if (!mesh.hard[h]) continue;
        const double length = norm(points[mesh.to(h)] - points[v]);
        around += length;
        if (o >= 0) mean = mean + length * normalized(normal(o / 3));
      }
    sort_unique(vertices);
    const bool disk = 2 * ((int)vertices.size() + (int)region.size() - 1) == edges;
    if (!disk || norm(high - low) > options_.tolerance || norm(mean) < least_mean * around) continue;
    for (int v : vertices) region_[v] = n;
    ++n;
    for (int u : region) consider(heap, u);
  }
  return run(std::move(heap));
}

}  // namespace meshpipe
