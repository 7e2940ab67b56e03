// SPDX-License-Identifier: BSD-3-Clause
// Vertices so close to each other, compared with all around, that they are one.
#include <algorithm>
#include <array>
#include <cmath>

#include "lib/clean/repair.h"
#include "lib/core/bvh.h"
#include "lib/core/lists.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

/// Edges that leave a cluster are at least this many times as long as the sides of its bounding box. A
/// pole of errors of 1e-9 costs twice the triangles of the whole sphere; a hole of 1e-5 edges may be meant.
constexpr double cluster_gap = 1e6;

struct Edge {
  double length;
  int a, b;
};

/// Calls visit(Edge) for the edges of all triangles, on welded vertices.
template <class Visit>
void each_edge(const Mesh& mesh, const std::vector<int>& same, Visit visit) {
  for (const Tri& t : mesh.tris)
    for (int i = 0; i < 3; ++i) {
      const int a = same[t[i]], b = same[t[(i + 1) % 3]];
      if (a != b) visit(Edge{norm(mesh.points[a] - mesh.points[b]), a, b});
    }
}

/// Sets of vertices that grow by their shortest edges: an edge that joins two is the shortest that leaves
/// either, so that the gap around a set is known when it grows.
class Clusters {
 public:
  explicit Clusters(const Mesh& mesh)
      : grown_(mesh.points.size()), merged_(mesh.points.size()), next_(identity(mesh.points.size())) {
    for (const Vec3& p : mesh.points) box_.push_back({p, p});
  }
  int set_of(int v) { return grown_.find(v); }
  int cluster_of(int v) { return merged_.find(v); }
  void join(const Edge& e) {
    const int a = grown_.find(e.a), b = grown_.find(e.b);
    if (a == b) return;
    merge(a, e.length);
    merge(b, e.length);
    std::swap(next_[a], next_[b]);
    box_[a] = box_[b] = meshpipe::join(box_[a], box_[b]);
    grown_.join(a, b);
  }
  /// Makes a set one cluster if edges that leave it, of this length or more, are long enough.
  void merge(int set, double leaving) {
    const Vec3 d = box_[set].hi - box_[set].lo;  // its norm might vanish
    if (!(std::max({d.x, d.y, d.z}) * cluster_gap <= leaving && std::isfinite(leaving))) return;
    for (int v = next_[set]; v != set; v = next_[v]) merged_.join(set, v);
  }

 private:
  UnionFind grown_, merged_;
  std::vector<int> next_;  ///< the vertices of each set, in a circle
  std::vector<Box> box_;   ///< of each set, by its name
};

/// Leaves out the clusters around which triangles make more than one fan: a ring at a neck, whose two sides
/// would touch in a point.
void leave_out_necks(const Mesh& mesh, const std::vector<int>& cluster, std::vector<char>& isolated) {
  std::vector<std::array<int, 3>> links;  // cluster, and the ends of an edge opposite to it
  for (const Tri& t : mesh.tris)
    for (int i = 0; i < 3; ++i) {
      const int c = cluster[t[i]], a = cluster[t[(i + 1) % 3]], b = cluster[t[(i + 2) % 3]];
      if (isolated[c] && a != c && b != c && a != b) links.push_back({c, a, b});
    }
  std::sort(links.begin(), links.end());
  for (std::size_t first = 0, end; first < links.size(); first = end) {
    std::vector<int> around;
    for (end = first; end < links.size() && links[end][0] == links[first][0]; ++end)
      around.insert(around.end(), {links[end][1], links[end][2]});
    sort_unique(around);
    auto row = [&](int v) { return int(std::lower_bound(around.begin(), around.end(), v) - around.begin()); };
    UnionFind fan(around.size());
    for (std::size_t i = first; i < end; ++i) fan.join(row(links[i][1]), row(links[i][2]));
    for (int i = 0; i < (int)around.size(); ++i)
      if (fan.find(i) != fan.find(0)) isolated[links[first][0]] = 0;
  }
}

/// Flags the clusters, by their first vertices, that are no thin part of the surface, as the end of a needle
/// or the edge of a thin plate: none is adjacent to another, most of their triangles go away from them, and
/// these make one fan. `same`: as in merge_clusters.
std::vector<char> find_isolated(const Mesh& mesh, const std::vector<int>& same,
                                const std::vector<int>& cluster) {
  std::vector<int> away(cluster.size(), 0);  // triangles with one corner in it, less those within
  std::vector<char> several(cluster.size(), 0);
  for (std::size_t v = 0; v < cluster.size(); ++v) several[cluster[v]] |= cluster[v] != same[v];
  std::vector<char> isolated = several;
  for (const Tri& t : mesh.tris) {
    const int c[3] = {cluster[t[0]], cluster[t[1]], cluster[t[2]]};
    if (c[0] == c[1] && c[1] == c[2]) --away[c[0]];
    for (int i = 0; i < 3; ++i) {
      const int a = c[i], b = c[(i + 1) % 3];
      if (a != b && a != c[(i + 2) % 3]) ++away[a];
      if (a != b && several[a] && several[b]) isolated[a] = isolated[b] = 0;
    }
  }
  for (std::size_t v = 0; v < cluster.size(); ++v) isolated[v] = isolated[v] && away[v] > 0;
  leave_out_necks(mesh, cluster, isolated);
  return isolated;
}

}  // namespace

int merge_clusters(const Mesh& mesh, std::vector<int>& same, double& within) {
  double longest = 0, shortest = infinity;
  std::vector<Edge> edges;
  each_edge(mesh, same, [&](const Edge& e) {
    longest = std::max(longest, e.length), shortest = std::min(shortest, e.length);
  });
  if (!(shortest * cluster_gap <= longest)) return 0;
  each_edge(mesh, same, [&](const Edge& e) {
    if (e.length * cluster_gap <= longest) edges.push_back(e);
  });
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& e, const Edge& f) { return e.length < f.length; });
  Clusters clusters(mesh);
  for (const Edge& e : edges) clusters.join(e);
  std::vector<double> leaving(same.size(), infinity);
  each_edge(mesh, same, [&](const Edge& e) {
    const int a = clusters.set_of(e.a), b = clusters.set_of(e.b);
    if (a == b) return;
    leaving[a] = std::min(leaving[a], e.length);
    leaving[b] = std::min(leaving[b], e.length);
  });
  std::vector<int> cluster = same;
  for (int v = 0; v < (int)same.size(); ++v)
    if (clusters.set_of(v) == v) clusters.merge(v, leaving[v]);
  for (int& v : cluster) v = clusters.cluster_of(v);
  const std::vector<char> isolated = find_isolated(mesh, same, cluster);
  int count = 0;
  for (int v = 0; v < (int)same.size(); ++v) {
    const int kept = cluster[v];
    if (kept == same[v] || !isolated[kept]) continue;
    within = std::max(within, norm(mesh.points[v] - mesh.points[kept]));
    count += same[v] == v;
    same[v] = kept;
  }
  return count;
}

}  // namespace meshpipe
