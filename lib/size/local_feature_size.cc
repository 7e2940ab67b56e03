// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/local_feature_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "lib/core/edges.h"
#include "lib/core/lists.h"
#include "lib/core/normals.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/size/size.h"

namespace meshpipe {
namespace {

using std::numbers::pi;
constexpr double least_triangles = 12;  ///< of a closed component: those of a sphere with four edges around
constexpr double least_peak = 9 * pi / 180;  ///< radians around a peak: needles at sharper ones are excused
constexpr double least_of_mean = 1.0 / 64;   ///< of the mean size: less is not asked for by peaks
constexpr double full_bend = 0.7 * 2 * pi;   ///< of a ring by its curvature, which is that of a neighborhood
constexpr double opposite_sides = -0.31;     ///< largest cosine between the two ends of a ring at its vertex
constexpr double across = 0.4;  ///< largest mean cosine between the ring's plane and the surface's normals
constexpr double flat = 0.8;    ///< cosine between them at an edge; 0.6 to 0.9 tell the same loops from rings
constexpr double per_length = 1.5;    ///< size over the length of a line: kappa 0.8 between such edges
constexpr double least_line = 0.001;  ///< of the size asked for: a shorter line is a point
constexpr double least_area = 0.2;    ///< of a circle as long: a path there and back the same way has none

/// Finds the rings around tubes, from one vertex after the other.
class TubeFinder {
 public:
  explicit TubeFinder(const Mesh& mesh)
      : mesh_(mesh),
        next_(neighbors_of(mesh)),
        normal_(vertex_area_vectors(mesh)),
        distance_(mesh.points.size(), infinity),
        from_(mesh.points.size()),
        branch_(mesh.points.size()) {}

  /// Returns the length of the shortest ring through v, at most `below`. Leaves the vertices nearer than half
  /// of it in near(), with their distances.
  double ring(int v, double below) {
    for (int u : reached_) distance_[u] = infinity;
    near_.clear();
    reached_.assign(1, v);
    distance_[v] = 0, from_[v] = branch_[v] = v;
    double shortest = below;
    shortest_paths(reached_, distance_, [&](int a, auto reach) {
      if (distance_[a] > 0.5 * shortest) return false;
      near_.push_back(a);
      for (int b : next_[a]) {
        const double l = distance_[a] + norm(mesh_.points[b] - mesh_.points[a]), before = distance_[b];
        if (l + before < shortest && from_[a] != b && from_[b] != a && is_ring(v, a, b))
          shortest = l + before;
        if (!reach(b, l)) continue;
        if (before == infinity) reached_.push_back(b);
        from_[b] = a, branch_[b] = a == v ? b : branch_[a];
      }
      return true;
    });
    return shortest;
  }

  const std::vector<int>& near() const { return near_; }
  double distance(int v) const { return distance_[v]; }

 private:
  /// Whether the paths to a and b leave v on opposite sides, and their ring lies across the surface.
  bool is_ring(int v, int a, int b) const {
    if (a == v || b == v) return false;
    const Vec3 p = mesh_.points[v], x = mesh_.points[branch_[a]] - p, y = mesh_.points[branch_[b]] - p;
    if (dot(x, y) > opposite_sides * norm(x) * norm(y)) return false;
    Vec3 area = cross(mesh_.points[a] - p, mesh_.points[b] - p);
    for (int end : {a, b})
      for (int u = end; u != v; u = from_[u])
        area = area + (end == a ? 1.0 : -1.0) * cross(mesh_.points[from_[u]] - p, mesh_.points[u] - p);
    const Vec3 axis = normalized(area);
    if (lies_flat(a, b, axis)) return false;
    double along = std::abs(dot(axis, normalized(normal_[v])));
    int n = 2;
    for (int end : {a, b})
      for (int u = end; u != v; u = from_[u], ++n) {
        if (lies_flat(u, from_[u], axis)) return false;
        along += std::abs(dot(axis, normalized(normal_[u])));
      }
    const double length = distance_[a] + distance_[b] + norm(mesh_.points[a] - mesh_.points[b]);
    return along < across * n && norm(area) > least_area * length * length / (2 * pi);
  }

  /// Whether an edge is within a flat face in a loop's plane, as where it crosses the rim of a plate.
  bool lies_flat(int u, int w, Vec3 axis) const {
    double least = 1;
    for (std::size_t i = 0; i < next_[u].size(); i += 2)
      if (const int x = next_[u][i], y = next_[u][i + 1]; x == w || y == w) {
        const Vec3 n = cross(mesh_.points[x] - mesh_.points[u], mesh_.points[y] - mesh_.points[u]);
        least = std::min(least, std::abs(dot(axis, normalized(n))));
      }
    return least > flat;
  }

  const Mesh& mesh_;
  const Lists next_;  ///< as neighbors_of
  std::vector<Vec3> normal_;
  std::vector<double> distance_;
  std::vector<int> from_, branch_, reached_, near_;
};

/// Returns per triangle the area of its component; infinity if that has borders or model edges.
std::vector<double> closed_areas(const Connectivity& surface) {
  std::vector<int> component;
  std::vector<double> area(components(surface.opposite, component), 0);
  for (int h = 0; h < surface.n_half_edges(); ++h)
    area[component[h / 3]] +=
        surface.is_border(h) || surface.is_model(h) ? infinity : triangle_area(surface.mesh, h / 3) / 3;
  return rearranged(area, component);
}

}  // namespace

std::vector<double> closed_line_lengths(const Connectivity& surface) {
  const Mesh& mesh = surface.mesh;
  const int n = (int)mesh.points.size();
  std::vector<double> around(n, infinity);
  std::vector<std::array<int, 2>> ends(n, {-1, -1});  // the other ends of the first two edges
  std::vector<int> degree(n, 0);
  for (int h = 0; h < surface.n_half_edges(); ++h) {
    const int o = surface.opposite[h], a = surface.from(h), b = surface.to(h);
    if (o > h || (o >= 0 && !surface.is_model(h) && !surface.is_model(o))) continue;
    for (const auto& [x, y] : {std::array{a, b}, std::array{b, a}})
      if (degree[x]++ < 2) ends[x][degree[x] - 1] = y;
  }
  std::vector<char> seen(n, 0);
  std::vector<int> loop;
  for (int first = 0; first < n; ++first) {
    if (seen[first] || degree[first] != 2) continue;
    loop.clear();
    double length = 0;
    int v = first, before = ends[first][0];
    do {
      seen[v] = 1;
      loop.push_back(v);
      const int u = ends[v][ends[v][0] == before];
      length += norm(mesh.points[u] - mesh.points[v]);
      before = v, v = u;
    } while (v != first && degree[v] == 2 && !seen[v]);
    if (v != first) continue;  // it ends in a junction
    for (int u : loop) around[u] = std::min(around[u], length);
  }
  return around;
}

double least_at_peaks(const Mesh& mesh, const std::vector<double>& size) {
  return least_of_mean * size_for_count(total_area(mesh), count_for_size(mesh, size));
}

double least_tube_curvature(const std::vector<double>& size) {
  return full_bend / (ring_edges * *std::max_element(size.begin(), size.end()));
}

std::vector<double> local_feature_size(const Connectivity& surface, const std::vector<double>& curvature,
                                       const std::vector<double>& size) {
  const Mesh& mesh = surface.mesh;
  const std::size_t n = mesh.points.size();
  std::vector<double> feature = closed_line_lengths(surface), bend(n, 0);
  for (double& x : feature) x /= ring_edges;
  const double least = least_at_peaks(mesh, size);
  // a quarter of the way around at a size's distance from a peak
  for (const Peak& p : sharp_peaks(surface, size))
    feature[p.vertex] = std::max(least, size[p.vertex] * std::max(p.angle, least_peak) / ring_edges);
  const std::vector<double> whole = closed_areas(surface);
  for (std::size_t t = 0; t < mesh.tris.size(); ++t)
    for (int v : mesh.tris[t]) {
      const double most = size_for_count(whole[t], least_triangles);
      if (most < size[v]) feature[v] = std::min(feature[v], most);
      bend[v] = std::max(bend[v], curvature[t]);
    }
  std::optional<TubeFinder> finder;  // most surfaces of a scan bend nowhere as much
  std::vector<char> done(n, 0);
  for (int v = 0; v < (int)n; ++v) {
    const double below = ring_edges * size[v];
    if (done[v] || !(bend[v] * below > full_bend)) continue;
    TubeFinder& tubes = finder ? *finder : finder.emplace(mesh);
    const double length = tubes.ring(v, below);
    // every vertex of a tube is within a quarter of its ring of one that was searched from
    for (int u : tubes.near()) {
      if (tubes.distance(u) > length / (length < below ? 4 : 16)) break;
      done[u] = 1;
      if (length < below) feature[u] = std::min(feature[u], length / ring_edges);
    }
  }
  return feature;
}

void lower_along_short_lines(const Mesh& mesh, std::vector<double>& size) {
  const int n = (int)mesh.points.size();
  std::vector<std::array<int, 2>> edges;
  for_each_edge(mesh.tris, n, [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]);
    if (uses.size() > 2) edges.push_back({origin(mesh.tris, h), target(mesh.tris, h)});
  });
  const Lists star = lists_of(n, [&](auto use) {
    for (int e = 0; e < (int)edges.size(); ++e)
      for (int v : edges[e]) use(v, e);
  });
  const std::vector<double> asked = size;
  std::vector<int> line;
  for (int v = 0; v < n; ++v) {
    if (star[v].size() == 2) continue;
    for (int first : star[v]) {
      line.assign(1, v);
      double length = 0;
      for (int e = first;;) {
        const int w = edges[e][edges[e][0] == line.back()];
        length += norm(mesh.points[w] - mesh.points[line.back()]);
        line.push_back(w);
        if (star[w].size() != 2 || per_length * length >= asked[w]) break;
        e = star[w][star[w][0] == e];
      }
      if (star[line.back()].size() == 2) continue;  // long enough
      for (int w : line) size[w] = std::min(size[w], std::max(per_length * length, least_line * asked[w]));
    }
  }
}

}  // namespace meshpipe
