// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/handles.h"

#include <algorithm>

#include "lib/core/connectivity.h"
#include "lib/core/parallel.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/topology.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

constexpr double unreached = 1e300;
constexpr int many_handles = 16;  // from there on two roots, not four: loops are 9 % longer

/// The surface with what has been cut so far.
struct Work {
  const Mesh& mesh;
  const std::vector<int>& opposite;
  std::vector<int> leaving;   // of each vertex: a half-edge, or -1
  std::vector<char> blocked;  // vertices on loops
  std::vector<int> cap;       // of each half-edge on a border or loop: the cap of its side, or -1
  int n_caps = 0;
};

Work make_work(const Connectivity& view) {
  const std::vector<Tri>& tris = view.mesh.tris;
  const std::size_t n = view.mesh.points.size(), n_half_edges = view.opposite.size();
  Work w{view.mesh, view.opposite, std::vector<int>(n, -1), std::vector<char>(n, 0),
         std::vector<int>(n_half_edges, -1)};
  for (int h = 0; h < (int)n_half_edges; ++h) w.leaving[origin(tris, h)] = h;
  for (const std::vector<int>& loop : boundary_loops(view.opposite)) {
    // a loop along a border would leave a part of no width
    for (int h : loop) w.cap[h] = w.n_caps, w.blocked[origin(tris, h)] = 1;
    ++w.n_caps;
  }
  return w;
}

/// Shortest paths from a root among the vertices that are not blocked: distance, and the half-edge that leads
/// to each vertex (-1 at the root; one side of the edge, whose other vertex is nearer).
struct Paths {
  std::vector<double> distance;
  std::vector<int> from;  // vertex before
  std::vector<int> edge;
};

Paths paths_from(const Work& w, int root) {
  const std::vector<Tri>& tris = w.mesh.tris;
  const std::size_t n = w.mesh.points.size();
  Paths p{std::vector<double>(n, unreached), std::vector<int>(n, -1), std::vector<int>(n, -1)};
  p.distance[root] = 0;
  shortest_paths({root}, p.distance, [&](int v, auto reach) {
    auto go = [&](int u, int h) {
      if (!w.blocked[u] && reach(u, p.distance[v] + edge_length(w.mesh, h))) p.from[u] = v, p.edge[u] = h;
    };
    for_each_spoke(w.opposite, w.leaving[v], [&](int h) {
      go(target(tris, h), h);
      go(origin(tris, prev(h)), prev(h));
    });
  });
  return p;
}

struct Loop {
  double length = unreached;
  std::vector<int> half_edges;
};

/// The half-edge from a to b, its triangle on the left; -1 if the surface is only on its right.
int between(const Work& w, int a, int b) {
  int found = -1;
  for_each_spoke(w.opposite, w.leaving[a], [&](int h) {
    if (target(w.mesh.tris, h) == b) found = h;
    return found < 0;
  });
  return found;
}

/// The shortest of the loops that an edge closes with the paths to its ends, among the edges left over by the
/// tree of paths and a spanning tree of the triangles and caps whose edges close the longest loops. They are
/// as many as twice the handles left, and none separates the surface.
Loop shortest_from(const Work& w, int root) {
  const std::vector<Tri>& tris = w.mesh.tris;
  const Paths p = paths_from(w, root);
  const int n_tris = (int)tris.size();
  UnionFind tree(n_tris + w.n_caps);
  std::vector<std::pair<double, int>> candidates;
  for (int h = 0; h < 3 * n_tris; ++h) {
    if (w.cap[h] >= 0) {
      tree.join(h / 3, n_tris + w.cap[h]);
      continue;
    }
    const int o = w.opposite[h], a = origin(tris, h), b = target(tris, h);
    if (o < h) continue;
    if (p.distance[a] == unreached || p.distance[b] == unreached)
      tree.join(h / 3, o / 3);
    else if (p.edge[a] != h && p.edge[a] != o && p.edge[b] != h && p.edge[b] != o)
      candidates.push_back({-(p.distance[a] + p.distance[b] + edge_length(w.mesh, h)), h});
  }
  std::sort(candidates.begin(), candidates.end());
  int closing = -1;
  for (auto [length, h] : candidates)
    if (!tree.join(h / 3, w.opposite[h] / 3)) closing = h;  // the last is the shortest
  Loop loop;
  if (closing < 0) return loop;
  // both paths back to the vertex where they part
  std::vector<int> left{origin(tris, closing)}, right{target(tris, closing)};
  while (left.back() != right.back()) {
    std::vector<int>& farther = p.distance[left.back()] > p.distance[right.back()] ? left : right;
    farther.push_back(p.from[farther.back()]);
  }
  left.pop_back();
  std::vector<int> around(left.rbegin(), left.rend());
  around.insert(around.end(), right.begin(), right.end());
  loop.length = 0;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const int h = between(w, around[i], around[(i + 1) % around.size()]);
    if (h < 0 || w.opposite[h] < 0) return {};  // along a border
    loop.half_edges.push_back(h);
    loop.length += edge_length(w.mesh, h);
  }
  return loop;
}

/// The shortest that is found by moving on: a loop through one of the vertices of the last may be shorter.
Loop shortest_near(const Work& w, int root) {
  Loop best;
  for (int move = 0; move < 3; ++move) {
    Loop loop = shortest_from(w, root);
    if (loop.length >= best.length) break;
    root = origin(w.mesh.tris, loop.half_edges[loop.half_edges.size() / 2]);
    best = std::move(loop);
  }
  return best;
}

/// Up to n vertices that are not blocked, each the farthest from those before.
std::vector<int> far_apart(const Work& w, int n) {
  const std::vector<Vec3>& points = w.mesh.points;
  std::vector<int> found;
  std::vector<double> nearest(points.size());  // to those found
  for (std::size_t v = 0; v < points.size(); ++v)
    nearest[v] = w.blocked[v] || w.leaving[v] < 0 ? -1 : unreached;
  for (int i = 0; i < n; ++i) {
    const auto v = std::max_element(nearest.begin(), nearest.end()) - nearest.begin();
    if (nearest[v] < 0) break;
    for (std::size_t u = 0; u < points.size(); ++u)
      nearest[u] = std::min(nearest[u], norm(points[u] - points[v]));
    found.push_back((int)v);
  }
  return found;
}

}  // namespace

std::vector<std::vector<int>> handle_loops(const Connectivity& view, int genus) {
  Work w = make_work(view);
  std::vector<std::vector<int>> loops;
  while ((int)loops.size() < genus) {
    const std::vector<int> roots = far_apart(w, genus > many_handles ? 2 : 4);
    std::vector<Loop> found(roots.size() + 1);
    parallel_for((int)roots.size(), [&](int i) { found[i] = shortest_near(w, roots[i]); });
    const Loop& best = *std::min_element(found.begin(), found.end(),
                                         [](const Loop& a, const Loop& b) { return a.length < b.length; });
    if (best.half_edges.empty()) break;
    for (int h : best.half_edges) {
      w.blocked[origin(view.mesh.tris, h)] = 1;
      w.cap[h] = w.n_caps, w.cap[view.opposite[h]] = w.n_caps + 1;
    }
    w.n_caps += 2;
    loops.push_back(best.half_edges);
  }
  return loops;
}

std::vector<int> label_by_sides(const Connectivity& view, const std::vector<std::vector<int>>& loops) {
  const std::vector<int>& opposite = view.opposite;
  const Mesh& mesh = view.mesh;
  const int n = (int)mesh.tris.size();
  std::vector<char> cut(3 * n, 0);
  std::vector<int> label(n, -1), seeds;
  std::vector<double> distance(n, unreached);
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (int h : loops[i])
      for (int side : {0, 1}) {
        const int g = side ? opposite[h] : h;
        cut[g] = 1;
        if (label[g / 3] >= 0) continue;  // between two loops
        label[g / 3] = 2 * (int)i + side;
        distance[g / 3] = 0;
        seeds.push_back(g / 3);
      }
  shortest_paths(seeds, distance, [&](int t, auto reach) {
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const int o = opposite[h] / 3;
      if (opposite[h] >= 0 && !cut[h] && reach(o, distance[t] + norm(centroid(mesh, o) - centroid(mesh, t))))
        label[o] = label[t];
    }
  });
  return label;
}

}  // namespace meshpipe
