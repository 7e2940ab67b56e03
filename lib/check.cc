// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>

#include "lib/edges.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

void note(int& count, int& first, int triangle) {
  if (count++ == 0) first = triangle;
}

/// Vertices where two corners of the mesh are not joined by a chain of triangles round the vertex.
void find_pinched(const Mesh& mesh, const std::vector<int>& opposite, Connectivity& c) {
  const int n = 3 * (int)mesh.tris.size();
  std::vector<char> corner_seen(n, 0), vertex_seen(mesh.points.size(), 0);
  for (int h = 0; h < n; ++h) {
    if (corner_seen[h]) continue;
    char& vertex = vertex_seen[origin(mesh.tris, h)];
    if (vertex) note(c.pinched, c.first_pinched, h / 3);
    vertex = 1;
    int g = h;
    do {
      corner_seen[g] = 1;
      g = opposite[prev(g)];
    } while (g >= 0 && g != h);
    if (g >= 0) continue;
    // the fan ends at the border; its other half lies on the other side
    for (g = opposite[h]; g >= 0; g = opposite[g]) corner_seen[g = next(g)] = 1;
  }
}

}  // namespace

Connectivity connectivity_of(const Mesh& mesh) {
  Connectivity c;
  c.faces = (int)mesh.tris.size();
  const int n = (int)mesh.points.size();
  std::vector<char> used(n, 0);
  for (int t = 0; t < c.faces; ++t) {
    const Tri& v = mesh.tris[t];
    for (int x : v) used[x] = 1;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) note(c.degenerate, c.first_degenerate, t);
  }
  c.vertices = (int)std::count(used.begin(), used.end(), 1);
  std::vector<int> opposite(3 * mesh.tris.size(), -1);
  for_each_edge(mesh.tris, n, [&](std::span<const EdgeUse> uses) {
    ++c.edges;
    const int h = half_edge(uses[0]);
    if (uses.size() > 2) return note(c.nonmanifold, c.first_nonmanifold, half_edge(uses.back()) / 3);
    if (uses.size() < 2) return;
    const int g = half_edge(uses[1]);
    if (origin(mesh.tris, h) == origin(mesh.tris, g)) return note(c.turned, c.first_turned, h / 3);
    opposite[h] = g;
    opposite[g] = h;
  });
  if (!c.sound()) return c;
  find_pinched(mesh, opposite, c);
  if (!c.sound()) return c;
  std::vector<int> component;
  c.components = components(opposite, component);
  c.loops = (int)boundary_loops(opposite).size();
  c.genus = (2 * c.components - (c.vertices - c.edges + c.faces) - c.loops) / 2;  // the paper's eq. (2)
  return c;
}

Quality quality_of(const Mesh& mesh, const std::vector<double>& size) {
  constexpr double degree = 180 / std::numbers::pi;
  Quality q;
  q.kappa_histogram.assign(50, 0);
  const int n = (int)mesh.tris.size();
  if (n == 0) return q;
  std::vector<double> kappas(n), smallest(n), largest(n);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t) {
    const Vec3 &a = mesh.points[mesh.tris[t][0]], &b = mesh.points[mesh.tris[t][1]],
               &c = mesh.points[mesh.tris[t][2]];
    kappas[t] = kappa(a, b, c);
    const double x = angle(b - a, c - a), y = angle(c - b, a - b), z = angle(a - c, b - c);
    smallest[t] = std::min({x, y, z}) * degree;
    largest[t] = std::max({x, y, z}) * degree;
  }
  q.worst = (int)(std::min_element(kappas.begin(), kappas.end()) - kappas.begin());
  q.kappa_min = kappas[q.worst];
  q.kappa_mean = std::accumulate(kappas.begin(), kappas.end(), 0.0) / n;
  q.min_angle = *std::min_element(smallest.begin(), smallest.end());
  q.mean_min_angle = std::accumulate(smallest.begin(), smallest.end(), 0.0) / n;
  q.max_angle = *std::max_element(largest.begin(), largest.end());
  for (double k : kappas) ++q.kappa_histogram[std::clamp((int)(50 * k), 0, 49)];
  const auto rank = kappas.begin() + n / 100;
  std::nth_element(kappas.begin(), rank, kappas.end());
  q.kappa_p01 = *rank;

  std::vector<double> length;
  length.reserve(3 * mesh.tris.size() / 2 + 16);
  std::vector<int> valence(mesh.points.size(), 0);
  std::vector<char> border(mesh.points.size(), 0);
  for (const Tri& t : mesh.tris)
    for (int v : t) ++valence[v];
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    const int a = origin(mesh.tris, half_edge(uses[0])), b = target(mesh.tris, half_edge(uses[0]));
    const double l = norm(mesh.points[a] - mesh.points[b]);
    length.push_back(size.empty() ? l : 2 * l / (size[a] + size[b]));
    if (uses.size() != 2) border[a] = border[b] = 1;
  });
  const double count = (double)length.size();
  double mean = std::accumulate(length.begin(), length.end(), 0.0) / count, square = 0;
  const double unit = size.empty() && mean > 0 ? mean : 1;
  for (double l : length) square += (l - mean) * (l - mean);
  q.edge_min = *std::min_element(length.begin(), length.end()) / unit;
  q.edge_max = *std::max_element(length.begin(), length.end()) / unit;
  q.edge_mean = mean / unit;
  q.edge_deviation = std::sqrt(square / count) / unit;

  int inner = 0, good = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (valence[v] && !border[v]) {
      ++inner;
      good += valence[v] >= 5 && valence[v] <= 7;
    }
  q.valence567 = inner ? (double)good / inner : 1;
  return q;
}

namespace {

constexpr int chunk = 512;  // triangles or vertices that one thread takes on

struct OneSided {
  double largest = 0, bounded = 0;  ///< the latter with what lies between the samples
  double weight = 0, sum = 0, squares = 0;
  Vec3 place;

  void add(double distance, double reach, double w, Vec3 p) {
    if (distance > largest) {
      largest = distance;
      place = p;
    }
    bounded = std::max(bounded, distance + reach);
    weight += w;
    sum += w * distance;
    squares += w * distance * distance;
  }
  void add(const OneSided& o) {
    if (o.largest > largest) {
      largest = o.largest;
      place = o.place;
    }
    bounded = std::max(bounded, o.bounded);
    weight += o.weight;
    sum += o.sum;
    squares += o.squares;
  }
};

/// Nearest distances of points that come close to each other one by one: each search starts where the last
/// ended.
class Seeker {
 public:
  explicit Seeker(const Bvh& tree) : tree_(tree) {}
  double operator()(Vec3 p) {
    last_ = last_.place.face < 0 ? tree_.nearest(p) : tree_.nearest(p, last_);
    return last_.distance;
  }

 private:
  const Bvh& tree_;
  Bvh::Hit last_;
};

/// Distances of all vertices, taken in the order of the triangles that use them first.
std::vector<double> vertex_distances(const Mesh& from, const Bvh& from_tree, const Bvh& to_tree) {
  std::vector<int> vertices;
  std::vector<char> seen(from.points.size(), 0);
  for (int t : from_tree.order())
    for (int v : from.tris[t])
      if (!seen[v]) {
        seen[v] = 1;
        vertices.push_back(v);
      }
  std::vector<double> distances(from.points.size(), 0);
  const int n = (int)vertices.size();
#pragma omp parallel for schedule(dynamic)
  for (int first = 0; first < n; first += chunk) {
    Seeker distance(to_tree);
    for (int i = first; i < std::min(n, first + chunk); ++i)
      distances[vertices[i]] = distance(from.points[vertices[i]]);
  }
  return distances;
}

OneSided distance_from(const Mesh& from, const Bvh& from_tree, const Bvh& to_tree, int samples) {
  const int n = (int)from.tris.size(), chunks = (n + chunk - 1) / chunk;
  const double total = total_area(from);
  const std::vector<double> at_vertex = vertex_distances(from, from_tree, to_tree);
  std::vector<OneSided> part(chunks);
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < chunks; ++k) {
    Seeker distance(to_tree);
    for (int i = k * chunk; i < std::min(n, (k + 1) * chunk); ++i) {
      const Tri& t = from.tris[from_tree.order()[i]];
      const Vec3 &a = from.points[t[0]], &b = from.points[t[1]], &c = from.points[t[2]];
      const double area = 0.5 * norm(area_vector(a, b, c));
      // m^2 equal triangles, some of them upside down; all reach as far from their centres
      const int m = total > 0 ? std::max(1, (int)std::lround(std::sqrt(samples * (area / total)))) : 1;
      const Vec3 centre = 1.0 / 3 * (a + b + c);
      const double reach = std::max({norm(a - centre), norm(b - centre), norm(c - centre)}) / m;
      // a triangle that is not cut takes the rule that is exact for quadratic functions: 3/4 centre, 1/12 a
      // corner
      const double corner_weight = m == 1 ? area / 12 : 0,
                   weight = (area - 3 * corner_weight) / ((double)m * m);
      for (int v : t) part[k].add(at_vertex[v], 0, corner_weight, from.points[v]);
      auto sample = [&](double u, double v) {
        const Vec3 p = a + u / m * (b - a) + v / m * (c - a);
        part[k].add(distance(p), reach, weight, p);
      };
      for (int v = 0; v < m; ++v)
        for (int u = 0; u + v < m; ++u) {
          sample(u + 1.0 / 3, v + 1.0 / 3);
          if (u + v + 1 < m) sample(u + 2.0 / 3, v + 2.0 / 3);
        }
    }
  }
  OneSided all;
  for (const OneSided& p : part) all.add(p);
  return all;
}

/// The border as triangles without area, which are edges to the tree.
Mesh border_of(const Mesh& mesh) {
  Mesh border;
  border.points = mesh.points;
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    if (uses.size() != 1) return;
    const int h = half_edge(uses[0]), a = origin(mesh.tris, h), b = target(mesh.tris, h);
    border.tris.push_back({a, b, b});
  });
  return border;
}

double border_distance(const Mesh& reference, const Mesh& mesh) {
  const Mesh a = border_of(reference), b = border_of(mesh);
  if (a.tris.empty() && b.tris.empty()) return 0;
  if (a.tris.empty() || b.tris.empty()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (auto [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    const Bvh tree(*to);
    Seeker distance(tree);
    for (const Tri& t : from->tris)
      for (int i = 0; i < 8; ++i)
        worst = std::max(worst, distance(lerp(from->points[t[0]], from->points[t[1]], i / 8.0)));
  }
  return worst;
}

}  // namespace

Distance distance_between(const Mesh& reference, const Mesh& mesh, int samples) {
  return distance_between(reference, Bvh(reference), mesh, Bvh(mesh), samples);
}

Distance distance_between(const Mesh& reference, const Bvh& reference_tree, const Mesh& mesh,
                          const Bvh& mesh_tree, int samples) {
  const OneSided there = distance_from(mesh, mesh_tree, reference_tree, samples);
  const OneSided back = distance_from(reference, reference_tree, mesh_tree, samples);
  const double d = diagonal(reference), unit = d > 0 ? d : 1;
  auto mean = [](const OneSided& o) { return o.weight > 0 ? o.sum / o.weight : o.largest; };
  auto rms = [](const OneSided& o) { return o.weight > 0 ? std::sqrt(o.squares / o.weight) : o.largest; };
  Distance r;
  r.to_reference = there.largest / unit;
  r.to_mesh = back.largest / unit;
  r.hausdorff = std::max(r.to_reference, r.to_mesh);
  r.place = there.largest >= back.largest ? there.place : back.place;
  r.mean = std::max(mean(there), mean(back)) / unit;
  r.rms = std::max(rms(there), rms(back)) / unit;
  r.bound = std::max(there.bounded, back.bounded) / unit - r.hausdorff;
  r.boundary = border_distance(reference, mesh) / unit;
  return r;
}

}  // namespace meshpipe
