// SPDX-License-Identifier: BSD-3-Clause
#include "lib/handles.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>

namespace meshpipe {
namespace {

constexpr double unreached = 1e300;

double edge_length(const Mesh& mesh, int h) {
  return norm(mesh.points[target(mesh.tris, h)] - mesh.points[origin(mesh.tris, h)]);
}

/// The surface with what has been cut so far.
struct Work {
  const Mesh& mesh;
  const std::vector<int>& opposite;
  std::vector<int> start, outgoing;  // half-edges by their origins
  std::vector<char> blocked;         // vertices on loops
  std::vector<int> cap;              // of each half-edge on a border or loop: the cap of its side, or -1
  int n_caps = 0;
};

Work make_work(const Mesh& mesh, const std::vector<int>& opposite) {
  Work w{mesh, opposite, {}, {}, {}, {}, 0};
  const int n = (int)opposite.size();
  w.start.assign(mesh.points.size() + 1, 0);
  for (int h = 0; h < n; ++h) ++w.start[origin(mesh.tris, h) + 1];
  std::partial_sum(w.start.begin(), w.start.end(), w.start.begin());
  w.outgoing.resize(n);
  std::vector<int> fill(w.start.begin(), w.start.end() - 1);
  for (int h = 0; h < n; ++h) w.outgoing[fill[origin(mesh.tris, h)]++] = h;
  w.blocked.assign(mesh.points.size(), 0);
  w.cap.assign(n, -1);
  for (int h = 0; h < n; ++h) {
    if (opposite[h] >= 0 || w.cap[h] >= 0) continue;
    for (int g = h; w.cap[g] < 0;) {
      w.cap[g] = w.n_caps;
      for (g = next(g); opposite[g] >= 0;) g = next(opposite[g]);
    }
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
  Paths p;
  p.distance.assign(w.mesh.points.size(), unreached);
  p.from.assign(w.mesh.points.size(), -1);
  p.edge.assign(w.mesh.points.size(), -1);
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  queue.push({p.distance[root] = 0, root});
  while (!queue.empty()) {
    const double d = queue.top().first;
    const int v = queue.top().second;
    queue.pop();
    if (d > p.distance[v]) continue;
    auto reach = [&](int u, int h) {
      const double e = d + edge_length(w.mesh, h);
      if (w.blocked[u] || e >= p.distance[u]) return;
      p.distance[u] = e;
      p.from[u] = v;
      p.edge[u] = h;
      queue.push({e, u});
    };
    for (int i = w.start[v]; i < w.start[v + 1]; ++i) {
      reach(target(tris, w.outgoing[i]), w.outgoing[i]);
      reach(origin(tris, prev(w.outgoing[i])), prev(w.outgoing[i]));
    }
  }
  return p;
}

int root_of(std::vector<int>& parent, int v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

struct Loop {
  double length = unreached;
  std::vector<int> half_edges;
};

/// The half-edge from a to b, its triangle on the left; -1 if the surface is only on its right.
int between(const Work& w, int a, int b) {
  for (int i = w.start[a]; i < w.start[a + 1]; ++i)
    if (target(w.mesh.tris, w.outgoing[i]) == b) return w.outgoing[i];
  return -1;
}

/// The shortest of the loops that an edge closes with the paths to its ends, among the edges left over by the
/// tree of paths and a spanning tree of the triangles and caps whose edges close the longest loops. They are
/// as many as twice the handles left, and none separates the surface.
Loop shortest_from(const Work& w, int root) {
  const std::vector<Tri>& tris = w.mesh.tris;
  const Paths p = paths_from(w, root);
  const int n_tris = (int)tris.size();
  std::vector<int> parent(n_tris + w.n_caps);
  std::iota(parent.begin(), parent.end(), 0);
  std::vector<std::pair<double, int>> candidates;
  auto join = [&](int a, int b) {
    a = root_of(parent, a), b = root_of(parent, b);
    parent[std::max(a, b)] = std::min(a, b);
    return a != b;
  };
  for (int h = 0; h < 3 * n_tris; ++h) {
    if (w.cap[h] >= 0) {
      join(h / 3, n_tris + w.cap[h]);
      continue;
    }
    const int o = w.opposite[h], a = origin(tris, h), b = target(tris, h);
    if (o < h) continue;
    if (p.distance[a] == unreached || p.distance[b] == unreached)
      join(h / 3, o / 3);
    else if (p.edge[a] != h && p.edge[a] != o && p.edge[b] != h && p.edge[b] != o)
      candidates.push_back({-(p.distance[a] + p.distance[b] + edge_length(w.mesh, h)), h});
  }
  std::sort(candidates.begin(), candidates.end());
  int closing = -1;
  for (auto [length, h] : candidates)
    if (!join(h / 3, w.opposite[h] / 3)) closing = h;  // the last is the shortest
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

}  // namespace

std::vector<std::vector<int>> handle_loops(const Mesh& mesh, const std::vector<int>& opposite, int genus) {
  constexpr int roots = 4, moves = 3;
  Work w = make_work(mesh, opposite);
  for (int h = 0; h < (int)opposite.size(); ++h)  // a loop along a border would leave a part of no width
    if (opposite[h] < 0) w.blocked[origin(mesh.tris, h)] = 1;
  std::vector<std::vector<int>> loops;
  while ((int)loops.size() < genus) {
    Loop best;
    std::vector<double> nearest(mesh.points.size(), unreached);  // to the roots so far
    for (int i = 0; i < roots; ++i) {
      int root = -1;
      for (int v = 0; v < (int)nearest.size(); ++v)
        if (!w.blocked[v] && w.start[v] < w.start[v + 1] && (root < 0 || nearest[v] > nearest[root]))
          root = v;
      if (root < 0) break;
      for (int v = 0; v < (int)nearest.size(); ++v)
        nearest[v] = std::min(nearest[v], norm(mesh.points[v] - mesh.points[root]));
      // a loop through one of its own vertices may be shorter
      double before = unreached;
      for (int move = 0; move < moves; ++move) {
        Loop loop = shortest_from(w, root);
        if (loop.length >= before) break;
        before = loop.length;
        root = origin(mesh.tris, loop.half_edges[loop.half_edges.size() / 2]);
        if (loop.length < best.length) best = std::move(loop);
      }
    }
    if (best.half_edges.empty()) break;
    for (int h : best.half_edges) {
      w.blocked[origin(mesh.tris, h)] = 1;
      w.cap[h] = w.n_caps;
      w.cap[opposite[h]] = w.n_caps + 1;
    }
    w.n_caps += 2;
    loops.push_back(std::move(best.half_edges));
  }
  return loops;
}

std::vector<int> label_by_sides(const Mesh& mesh, const std::vector<int>& opposite,
                                const std::vector<std::vector<int>>& loops) {
  const int n = (int)mesh.tris.size();
  std::vector<char> cut(3 * n, 0);
  std::vector<int> label(n, -1);
  std::vector<double> distance(n, unreached);
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (int h : loops[i])
      for (int side : {0, 1}) {
        const int g = side ? opposite[h] : h;
        cut[g] = 1;
        if (label[g / 3] >= 0) continue;  // wedged between two loops
        label[g / 3] = 2 * (int)i + side;
        queue.push({distance[g / 3] = 0, g / 3});
      }
  auto centre = [&](int t) {
    const Tri& v = mesh.tris[t];
    return (1.0 / 3) * (mesh.points[v[0]] + mesh.points[v[1]] + mesh.points[v[2]]);
  };
  while (!queue.empty()) {
    const auto [d, t] = queue.top();
    queue.pop();
    if (d > distance[t]) continue;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const int o = opposite[h];
      if (o < 0 || cut[h]) continue;
      const double e = d + norm(centre(o / 3) - centre(t));
      if (e >= distance[o / 3]) continue;
      distance[o / 3] = e;
      label[o / 3] = label[t];
      queue.push({e, o / 3});
    }
  }
  return label;
}

}  // namespace meshpipe
