// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/topology.h"

#include <omp.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "lib/core/edges.h"
#include "lib/core/eigenvectors.h"
#include "lib/core/error.h"
#include "lib/core/parallel.h"
#include "lib/core/pieces.h"

namespace meshpipe {

static std::string edge_name(const std::vector<Tri>& tris, int h) {
  return "edge " + std::to_string(origin(tris, h)) + "-" + std::to_string(target(tris, h));
}

std::vector<int> opposite_halfedges(const std::vector<Tri>& tris, int n_vertices) {
  constexpr std::size_t worth_threads = 30000;  // triangles: 0.4 ms on one thread, 0.24 on two
  const std::size_t n = tris.size();
  std::size_t repeated = n;
#pragma omp parallel for schedule(static) reduction(min : repeated) if (n > worth_threads)
  for (std::size_t t = 0; t < n; ++t)
    if (const Tri& v = tris[t]; v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
      repeated = std::min(repeated, t);
  if (repeated < n) {
    const Tri& v = tris[repeated];
    throw NotAdmissible("triangle " + std::to_string(repeated) + " has vertex " +
                        std::to_string(v[1] == v[2] ? v[1] : v[0]) + " twice; run mclean first");
  }
  std::vector<int> opposite(3 * n, -1);
  auto match = [&](std::span<const EdgeUse> uses) {
    int h = half_edge(uses[0]);
    if (uses.size() > 2)
      throw NotAdmissible(edge_name(tris, h) + " of triangle " + std::to_string(h / 3) + " has " +
                          std::to_string(uses.size()) + " triangles, not 2; run mclean first");
    if (uses.size() < 2) return;
    int g = half_edge(uses[1]);
    if (origin(tris, h) == origin(tris, g))
      throw NotAdmissible(edge_name(tris, h) + " runs the same way in triangles " + std::to_string(h / 3) +
                          " and " + std::to_string(g / 3) + "; run mclean first");
    opposite[h] = g;
    opposite[g] = h;
  };
  // each of the ranges of vertices looks at all triangles: no more of them than threads
  const int ranges = n > worth_threads && !omp_in_parallel() ? std::min(omp_get_max_threads(), 16) : 1;
  auto from = [&](int i) { return (int)((std::int64_t)n_vertices * i / ranges); };
  parallel_for(ranges, [&](int i) { for_each_edge(tris, from(i), from(i + 1), match); });
  return opposite;
}

std::vector<std::vector<int>> opposite_of_parts(const std::vector<SubMesh>& parts, const Connectivity& whole,
                                                const std::vector<int>& label) {
  std::vector<int> number(label.size());
  for (const SubMesh& p : parts)
    for (std::size_t i = 0; i < p.face.size(); ++i) number[p.face[i]] = (int)i;
  std::vector<std::vector<int>> within(parts.size());
  auto take = [&](int p) {
    within[p].reserve(3 * parts[p].face.size());
    for (int t : parts[p].face)
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = whole.opposite[h];
        within[p].push_back(o < 0 || label[o / 3] != label[t] ? -1 : 3 * number[o / 3] + o % 3);
      }
  };
  parallel_for((int)parts.size(), take);
  return within;
}

int components(const std::vector<int>& opposite, std::vector<int>& component) {
  return number_pieces(opposite, component, [](int, int) { return true; });
}

std::vector<std::vector<int>> boundary_loops(const std::vector<int>& opposite) {
  std::vector<std::vector<int>> loops;
  std::vector<char> seen(opposite.size(), 0);
  for (int seed = 0; seed < (int)opposite.size(); ++seed) {
    if (opposite[seed] >= 0 || seen[seed]) continue;
    std::vector<int>& loop = loops.emplace_back();
    for (int h = seed; !seen[h];) {
      seen[h] = 1;
      loop.push_back(h);
      h = next_on_border(opposite, h);
    }
  }
  return loops;
}

std::vector<int> further_fans(const std::vector<Tri>& tris, const std::vector<int>& opposite,
                              int n_vertices) {
  std::vector<char> seen(opposite.size(), 0), has_fan(n_vertices, 0);
  std::vector<int> fans;
  for (int h = 0; h < (int)opposite.size(); ++h) {
    if (seen[h]) continue;
    if (std::exchange(has_fan[origin(tris, h)], 1)) fans.push_back(h);
    for_each_spoke(opposite, h, [&](int g) { seen[g] = 1; });
  }
  return fans;
}

int find_pinched_vertex(const std::vector<Tri>& tris, const std::vector<int>& opposite, int n_vertices) {
  int pinched = n_vertices;
  for (int h : further_fans(tris, opposite, n_vertices)) pinched = std::min(pinched, origin(tris, h));
  return pinched < n_vertices ? pinched : -1;
}

namespace {

/// Longest side of the box along the principal axes of the points, which turns with them.
double box_size(const std::vector<Vec3>& points) {
  Vec3 mean;
  for (Vec3 p : points) mean = mean + p;
  mean = (1.0 / (double)points.size()) * mean;
  Matrix3 inertia{};
  for (Vec3 p : points) {
    const double d[3] = {p.x - mean.x, p.y - mean.y, p.z - mean.z};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) inertia[i][k] += d[i] * d[k];
  }
  double size = 0;
  for (const Vec3& axis : eigenvectors(inertia)) {
    const Vec3 origin = points[0];
    double lo = 0, hi = 0;
    for (Vec3 p : points) {
      lo = std::min(lo, dot(p - origin, axis));
      hi = std::max(hi, dot(p - origin, axis));
    }
    size = std::max(size, hi - lo);
  }
  return size;
}

/// Largest of the distances along edges from the origins of `loop`, over the vertices they lead to. Vertices
/// wait in buckets as wide as a mean edge and may be reached again within one: in the end no distance can be
/// shortened, which is what Dijkstra's order would give to the bit, for linear work.
double edge_path_depth(const Connectivity& c, const std::vector<int>& loop) {
  const Mesh& mesh = c.mesh;
  const std::vector<int>& opposite = c.opposite;
  // a half-edge that leaves the vertex; the border's, if there is one
  std::vector<int> star(mesh.points.size(), -1);
  double width = 0;
  std::size_t edges = 0;
  for (int t = 0; t < (int)mesh.tris.size(); ++t)
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const int v = origin(mesh.tris, h);
      if (star[v] < 0 || opposite[h] < 0) star[v] = h;
      if (opposite[h] > h) continue;  // every edge once
      width += norm(mesh.points[target(mesh.tris, h)] - mesh.points[v]);
      ++edges;
    }
  width /= (double)edges;
  std::vector<double> distance(mesh.points.size(), infinity);
  std::vector<std::vector<int>> buckets(1);
  auto bucket_of = [&](double d) { return (std::size_t)(d / width); };
  for (int h : loop) {
    distance[origin(mesh.tris, h)] = 0;
    buckets[0].push_back(origin(mesh.tris, h));
  }
  std::vector<int> waiting;
  for (std::size_t b = 0; b < buckets.size(); ++b) {
    while (!buckets[b].empty()) {
      waiting.swap(buckets[b]);
      buckets[b].clear();
      for (int v : waiting) {
        const double d = distance[v];
        if (bucket_of(d) != b) continue;  // it went on with a shorter way
        auto reach = [&](int w) {
          if (distance[w] <= d) return;  // half of them: neither the point nor a root is needed
          const double along = d + norm(mesh.points[w] - mesh.points[v]);
          if (!(along < distance[w])) return;
          distance[w] = along;
          const std::size_t to = bucket_of(along);
          if (to >= buckets.size()) buckets.resize(to + 1);
          buckets[to].push_back(w);
        };
        for (int h = star[v];;) {
          reach(target(mesh.tris, h));
          const int in = prev(h);
          h = opposite[in];
          if (h < 0) reach(origin(mesh.tris, in));
          if (h < 0 || h == star[v]) break;
        }
      }
    }
    std::vector<int>().swap(buckets[b]);
  }
  double depth = 0;
  for (double d : distance)
    if (d < infinity) depth = std::max(depth, d);
  return depth;
}

/// `pieces` is the number of components; `number` translates the vertices for the message of a failure;
/// empty: they are what they are.
Topology measure(const Connectivity& c, int pieces, const std::vector<int>& number) {
  Topology t;
  const Mesh& mesh = c.mesh;
  const int n = (int)mesh.points.size();
  int pinched = find_pinched_vertex(c);
  if (pinched >= 0)
    throw NotAdmissible("vertex " + std::to_string(number.empty() ? pinched : number[pinched]) +
                        " joins triangles that share no edge; run mclean first");
  std::vector<std::vector<int>> loops = boundary_loops(c.opposite);
  const std::vector<char> used = used_points(mesh);
  std::size_t longest = 0, border = 0;
  for (const std::vector<int>& loop : loops) {
    t.loop_length.push_back(loop_length(mesh, loop));
    if (t.loop_length.back() > t.loop_length[longest]) longest = t.loop_length.size() - 1;
    border += loop.size();
  }
  t.components = pieces;
  t.vertices = (int)std::count(used.begin(), used.end(), 1);
  t.faces = (int)mesh.tris.size();
  t.edges = (int)((3 * mesh.tris.size() + border) / 2);
  t.loops = (int)loops.size();
  t.genus = (2 * t.components - (t.vertices - t.edges + t.faces) - t.loops) / 2;  // eq. (2)
  t.area = total_area(mesh);
  if (loops.empty() || t.loop_length[longest] == 0) return t;

  t.longest_loop = t.loop_length[longest];
  t.eta_cyl = std::numbers::pi * t.area / (t.longest_loop * t.longest_loop);
  t.eta_geo = edge_path_depth(c, loops[longest]) * std::numbers::pi / t.longest_loop;
  std::vector<Vec3> whole, rim;
  for (int v = 0; v < n; ++v)
    if (used[v]) whole.push_back(mesh.points[v]);
  for (int h : loops[longest]) rim.push_back(mesh.points[origin(mesh.tris, h)]);
  if (double size = box_size(rim); size > 0) t.eta_box = box_size(whole) / size;
  return t;
}

/// As measure, of part p, whose neighbors `opposite_of` gives; nothing if it has no triangles.
template <class OppositeOf>
Topology of_part(const SubMesh& mesh, int p, OppositeOf opposite_of) {
  if (mesh.tris.empty()) return {};
  try {
    const std::vector<int> opposite = opposite_of();
    std::vector<int> component;
    const int pieces = components(opposite, component);
    return measure({mesh, opposite}, pieces, mesh.vertex);
  } catch (const NotAdmissible& e) {
    throw NotAdmissible("part " + std::to_string(p) + ": " + e.what());
  }
}

/// Calls of(p) for every part in parallel.
template <class Of>
std::vector<Topology> for_parts(int n, const Of& of) {
  std::vector<Topology> parts(n);
  parallel_for(n, [&](int p) { parts[p] = of(p); });
  return parts;
}

}  // namespace

Topology topology_of(const Mesh& mesh) {
  const std::vector<int> opposite = opposite_halfedges(mesh);
  std::vector<int> component;
  return measure({mesh, opposite}, components(opposite, component), {});
}

std::vector<Topology> topology_of_parts(const Mesh& mesh, const std::vector<int>& part, int n) {
  const std::vector<SubMesh> meshes = split_by_label(mesh, part, n);
  return for_parts(
      n, [&](int p) { return of_part(meshes[p], p, [&] { return opposite_halfedges(meshes[p]); }); });
}

std::vector<Topology> topology_of_parts(const Connectivity& c, const std::vector<int>& part, int n) {
  const std::vector<SubMesh> meshes = split_by_label(c.mesh, part, n);
  std::vector<std::vector<int>> within = opposite_of_parts(meshes, c, part);
  return for_parts(n, [&](int p) { return of_part(meshes[p], p, [&] { return std::move(within[p]); }); });
}

std::vector<Topology> topology_of_components(const Connectivity& c, const std::vector<int>& component,
                                             int n) {
  if (n == 1) return {measure(c, 1, {})};
  const std::vector<SubMesh> meshes = split_by_label(c.mesh, component, n);
  const std::vector<std::vector<int>> within = opposite_of_parts(meshes, c, component);
  return for_parts(n, [&](int p) { return measure({meshes[p], within[p]}, 1, meshes[p].vertex); });
}

bool admissible(const Topology& t, double max_aspect) {
  return t.components == 1 && t.genus == 0 && t.loops >= 1 && t.eta_geo < max_aspect;
}

int count_parts(const Surface& surface) {
  const std::vector<int>& part = surface.face.get<int>("part");
  const int n_tris = (int)surface.tris.size();
  int n = 0;
  std::vector<int> faces(n_tris, 0);
  for (int t = 0; t < n_tris; ++t) {
    if (part[t] < 0 || part[t] >= n_tris)
      throw NotAdmissible("face " + std::to_string(t) + " has part " + std::to_string(part[t]) + " of " +
                          std::to_string(n_tris) + " triangles");
    ++faces[part[t]];
    n = std::max(n, part[t] + 1);
  }
  for (int p = 0; p < n; ++p)
    if (!faces[p])
      throw NotAdmissible("part " + std::to_string(p) + " of " + std::to_string(n) + " has no triangle");
  return n;
}

}  // namespace meshpipe
