// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/core/connectivity.h"
#include "lib/core/edges.h"
#include "lib/core/error.h"
#include "lib/core/junctions.h"
#include "lib/core/lists.h"
#include "lib/core/normals.h"
#include "lib/core/union_find.h"
#include "lib/smooth/separate.h"
#include "lib/smooth/smooth.h"
#include "lib/solids/solids.h"

namespace meshpipe {
namespace {

constexpr int sheet_steps = 25;                     // of each sign
constexpr double forward = 0.5, backward = -0.526;  // waves of more than about 9 edges pass (Taubin)
constexpr double least_cosine = 0.9;                // between normals of triangles whose edge is flipped
constexpr int volume_rounds = 4;  // of volume: what one holds back leaves the rest to others

/// What each vertex is averaged with: along lines for those on lines where sheets meet, else all neighbors,
/// as at the end of such a line, which would become ever shorter.
struct Net {
  Lists near;
  std::vector<char> held;
  double bound = 0;                         ///< of displacements, by default
  std::vector<std::pair<int, int>> smooth;  ///< triangles that are adjacent within a sheet
  std::vector<std::vector<int>> rigid;      ///< vertices of lines of one or two edges, which would vanish
};

struct Edge {
  int a, b, uses;
};

/// The vertices of lines of one or two edges that join ends of lines. `on_line` is per vertex, edges of lines
/// there.
std::vector<std::vector<int>> joined_ends(const std::vector<Edge>& edges, const std::vector<int>& on_line) {
  auto is_end = [&](int v) { return on_line[v] != 0 && on_line[v] != 2; };
  std::vector<int> near(on_line.size(), 0);  // ends next to a vertex
  for (const Edge& e : edges)
    if (e.uses > 2) near[e.b] += is_end(e.a), near[e.a] += is_end(e.b);
  auto joins = [&](int v) { return is_end(v) || near[v] == 2; };
  UnionFind ends(on_line.size());
  std::vector<int> found;
  for (const Edge& e : edges)
    if (e.uses > 2 && joins(e.a) && joins(e.b)) {
      ends.join(e.a, e.b);
      found.insert(found.end(), {e.a, e.b});
    }
  sort_unique(found);
  std::sort(found.begin(), found.end(), [&](int a, int b) {
    const int i = ends.find(a), j = ends.find(b);
    return i != j ? i < j : a < b;
  });
  std::vector<std::vector<int>> groups;
  for (int v : found) {
    if (groups.empty() || ends.find(groups.back()[0]) != ends.find(v)) groups.emplace_back();
    groups.back().push_back(v);
  }
  return groups;
}

Net make_net(const Mesh& mesh) {
  const int n = (int)mesh.points.size();
  std::vector<Edge> edges;
  std::vector<int> on_line(n, 0);
  std::vector<double> lengths;
  Net net;
  net.held.assign(n, 0);
  for_each_edge(mesh.tris, n, [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]), a = origin(mesh.tris, h), b = target(mesh.tris, h);
    edges.push_back({a, b, (int)uses.size()});
    lengths.push_back(edge_length(mesh, h));
    if (uses.size() == 2 && a != origin(mesh.tris, half_edge(uses[1])))
      net.smooth.push_back({h / 3, half_edge(uses[1]) / 3});
    if (uses.size() == 1) net.held[a] = net.held[b] = 1;
    if (uses.size() > 2) ++on_line[a], ++on_line[b];
  });
  net.bound = default_bound(std::move(lengths));
  net.rigid = joined_ends(edges, on_line);
  net.near = lists_of(n, [&](auto use) {
    for (const auto& [a, b, uses] : edges) {
      if (on_line[a] < 2 || uses > 2) use(a, b);
      if (on_line[b] < 2 || uses > 2) use(b, a);
    }
  });
  return net;
}

void step(const Net& net, const std::vector<Vec3>& start, double within, double share, std::vector<Vec3>& p) {
  std::vector<Vec3> to = p;
#pragma omp parallel for schedule(static)
  for (int v = 0; v < (int)p.size(); ++v) {
    const double n = (double)net.near[v].size();
    if (net.held[v] || n == 0) continue;
    Vec3 mean;
    for (int w : net.near[v]) mean = mean + 1.0 / n * p[w];
    const Vec3 d = p[v] + share * (mean - p[v]) - start[v];
    to[v] = start[v] + std::min(1.0, within / std::max(norm(d), 1e-300)) * d;
  }
  for (const std::vector<int>& group : net.rigid) {
    Vec3 mean;
    for (int v : group) mean = mean + 1.0 / (double)group.size() * (to[v] - start[v]);
    for (int v : group)
      if (!net.held[v]) to[v] = start[v] + mean;
  }
  p = std::move(to);
}

/// Of half-edges: the other one of an edge of two triangles, else -1, and whether it is on a line where
/// sheets meet. `edges` are the ends of all edges, in ascending order.
struct Sides {
  std::vector<int> opposite;
  std::vector<char> on_line;
  std::vector<std::array<int, 2>> edges;
};

Sides sides_of(const Mesh& mesh) {
  const std::size_t n = 3 * mesh.tris.size();
  Sides s{std::vector<int>(n, -1), std::vector<char>(n, 0), {}};
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]), g = half_edge(uses.back());
    const int a = origin(mesh.tris, h), b = target(mesh.tris, h);
    s.edges.push_back({std::min(a, b), std::max(a, b)});
    if (uses.size() == 2 && a == target(mesh.tris, g)) s.opposite[h] = g, s.opposite[g] = h;
    for (EdgeUse e : uses) s.on_line[half_edge(e)] = uses.size() > 2;
  });
  return s;
}

}  // namespace

double mean_angle(const Mesh& mesh, const std::vector<std::pair<int, int>>& adjacent) {
  const std::vector<Vec3> normal = face_normals(mesh);
  double sum = 0;
  for (auto [a, b] : adjacent) sum += std::pow(angle(normal[a], normal[b]), 2);
  return adjacent.empty() ? 0 : std::sqrt(sum / (double)adjacent.size()) * 180 / std::numbers::pi;
}

void flip_ears(Surface& surface) {
  Mesh joined = surface;
  join_borders(joined);
  const Sides sides = sides_of(joined);
  std::vector<char> stays(surface.tris.size(), 0);
  if (surface.face.has("model"))
    for (std::size_t t = 0; t < stays.size(); ++t) stays[t] = surface.face.get<std::uint8_t>("model")[t] != 0;
  const auto* patch = surface.face.has("patch") ? &surface.face.get<int>("patch") : nullptr;
  for (int h = 0; h < (int)sides.opposite.size(); ++h) {
    const int g = sides.opposite[h], t = h / 3, u = g / 3;
    if (g < 0 || !sides.on_line[next(h)] || !sides.on_line[prev(h)]) continue;
    if (sides.on_line[next(g)] || sides.on_line[prev(g)] || stays[t] || stays[u]) continue;
    if (patch && (*patch)[t] != (*patch)[u]) continue;
    auto flipped = [&](const Mesh& m) {
      const int a = origin(m.tris, h), b = target(m.tris, h), c = target(m.tris, next(h)),
                d = target(m.tris, next(g));
      return std::array{Tri{a, d, c}, Tri{d, b, c}};
    };
    const auto [x, y] = flipped(joined);
    if (std::binary_search(sides.edges.begin(), sides.edges.end(),
                           std::array{std::min(x[1], x[2]), std::max(x[1], x[2])}))
      continue;
    const std::vector<Vec3>& p = joined.points;
    const Vec3 normal = area_vector(joined, t) + area_vector(joined, u);
    auto flat = [&](Vec3 n) { return dot(n, normal) > least_cosine * norm(n) * norm(normal); };
    if (!flat(area_vector(joined, t)) || !flat(area_vector(p[x[0]], p[x[1]], p[x[2]])) ||
        !flat(area_vector(p[y[0]], p[y[1]], p[y[2]])))
      continue;
    for (Mesh* m : {&joined, static_cast<Mesh*>(&surface)}) {
      const auto both = flipped(*m);
      m->tris[t] = both[0];
      m->tris[u] = both[1];
    }
    stays[t] = stays[u] = 1;
  }
}

SmoothReport smooth_sheets(Surface& surface, const SmoothOptions& options) {
  if (surface.tris.empty()) throw NotAdmissible("the surface has no triangles");
  Mesh joined = surface;
  join_borders(joined);
  Net net = make_net(joined);
  if (options.keep_features) {
    const std::vector<std::uint8_t>& model = surface.face.get<std::uint8_t>("model");
    for (int h = 0; h < 3 * (int)joined.tris.size(); ++h)
      if (model[h / 3] >> h % 3 & 1) net.held[origin(joined.tris, h)] = net.held[target(joined.tris, h)] = 1;
  }
  SmoothReport r;
  r.within = options.within > 0 ? options.within : net.bound;
  r.angle_before = mean_angle(joined, net.smooth);
  const std::vector<Vec3> start = joined.points;
  const Solids before = find_solids(joined);
  for (int i = 0; i < sheet_steps; ++i)
    for (double share : {forward, backward}) step(net, start, r.within, share, joined.points);
  // moving vertices back takes volume again, which others then have to give
  int moved = 1;
  for (int i = 0; i < volume_rounds && moved > 0; ++i) {
    Compliance compliance{{}, std::vector<double>(start.size(), r.within), start};
    for (char held : net.held) compliance.share.push_back(!held);
    match_volumes(joined, before.sides, before.volume, std::move(compliance));
    r.moved_back += moved = separate(joined, start, net.held);
  }
  r.angle_after = mean_angle(joined, net.smooth);
  if (!(r.angle_after < r.angle_before)) {
    joined.points = start;
    r.angle_after = r.angle_before;
    r.moved_back = 0;
  }
  const std::vector<double> after = region_volumes(joined, before.sides, before.volume.size());
  for (int i = 1; i <= before.count(); ++i) {
    const double change = after[i] - before.volume[i];
    r.volume += before.volume[i];
    r.volume_change += change;
    if (before.volume[i] > 0)
      r.region_change = std::max(r.region_change, std::abs(change) / before.volume[i]);
  }
  for (std::size_t v = 0; v < start.size(); ++v) {
    const double way = norm(joined.points[v] - start[v]);
    r.bounded += way > 0.999 * r.within;
    if (way > r.farthest) r.farthest = way, r.farthest_at = start[v];
  }
  for (std::size_t t = 0; t < surface.tris.size(); ++t)
    for (int i : {0, 1, 2}) surface.points[surface.tris[t][i]] = joined.points[joined.tris[t][i]];
  return r;
}

}  // namespace meshpipe
