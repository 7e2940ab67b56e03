// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/balance.h"

#include <algorithm>
#include <climits>
#include <cmath>

#include "lib/core/connectivity.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/union_find.h"
#include "lib/numeric/laplacian.h"

namespace meshpipe {

namespace {

/// Strips so thin that the smoothed sides deny them, as on the way to a hole that lies out of the way, change
/// sides: the hole is then in the other half as a whole. A strip that holds larger pieces of its side
/// together stays. Returns whether there was one.
bool drop_hairs(const std::vector<Tri>& tris, int n_tris, const std::vector<double>& smoothed,
                std::vector<double>& field) {
  constexpr double deny = 0.4;
  const int n = (int)field.size();
  UnionFind pieces(n);
  std::vector<int> size(n, 0);
  auto is_thin = [&](int v) { return (field[v] > 0 ? smoothed[v] : -smoothed[v]) < -deny; };
  std::vector<std::pair<int, int>> touching;  // (thin vertex, vertex of its side that is not)
  for (int h = 0; h < 3 * n_tris; ++h) {
    const int a = origin(tris, h), b = target(tris, h);
    if ((field[a] > 0) != (field[b] > 0)) continue;
    if (is_thin(a) == is_thin(b))
      pieces.join(a, b);
    else
      touching.push_back(is_thin(a) ? std::pair(a, b) : std::pair(b, a));
  }
  for (int v = 0; v < n; ++v) ++size[pieces.find(v)];
  for (auto& [thin, piece] : touching) thin = pieces.find(thin), piece = pieces.find(piece);
  std::erase_if(touching, [&](auto& p) { return size[p.second] <= size[p.first]; });
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  std::vector<char> holds(n, 0);
  for (std::size_t i = 1; i < touching.size(); ++i)
    if (touching[i].first == touching[i - 1].first) holds[touching[i].first] = 1;
  bool any = false;
  std::vector<char> drop(n);
  for (int v = 0; v < n; ++v) any |= drop[v] = is_thin(v) && !holds[pieces.find(v)];
  for (int v = 0; v < n; ++v)
    if (drop[v]) field[v] = -field[v];
  return any;
}

/// How often the side changes from one neighbor of the vertex to the next; sets `on_border`.
int changes_around(const Connectivity& part, const std::vector<double>& field, int corner, bool& on_border) {
  int changes = 0;
  on_border = !part.for_each_spoke(
      corner, [&](int h) { changes += (field[part.to(h)] > 0) != (field[part.apex(h)] > 0); });
  return changes;
}

/// A half-edge that leaves each vertex of the part.
std::vector<int> corners_of(const FilledDisk& disk) {
  std::vector<int> corner(disk.part_vertices, -1);
  for (int h = 0; h < 3 * disk.part_tris; ++h) corner[origin(disk.tris, h)] = h;
  return corner;
}

/// The radius at each vertex from the weighted sums of its logarithms in the levels that it is in: not below
/// the mean edge, and smoothed, since levels do not meet smoothly.
std::vector<double> smooth_radius(const FilledDisk& disk, std::vector<double> log_radius,
                                  const std::vector<double>& weight) {
  const int n = disk.part_vertices;
  std::vector<double> length(n, 0), sum(n);
  std::vector<int> count(n, 0);
  for (int h = 0; h < 3 * disk.part_tris; ++h) {
    const int a = origin(disk.tris, h), b = target(disk.tris, h);
    const double l = edge_length(disk, h);
    length[a] += l, length[b] += l;
    ++count[a], ++count[b];
  }
  for (int v = 0; v < n; ++v) {
    const double edge = std::log(std::max(length[v] / std::max(count[v], 1), 1e-300));
    log_radius[v] = weight[v] > 0 ? std::max(log_radius[v] / weight[v], edge) : edge;
  }
  for (int round = 0; round < 5; ++round) {
    for (int v = 0; v < n; ++v) sum[v] = count[v] * log_radius[v];
    for (int h = 0; h < 3 * disk.part_tris; ++h) {
      const int a = origin(disk.tris, h), b = target(disk.tris, h);
      sum[a] += log_radius[b], sum[b] += log_radius[a];
    }
    for (int v = 0; v < n; ++v)
      if (count[v]) log_radius[v] = sum[v] / (2 * count[v]);
  }
  for (double& r : log_radius) r = std::exp(r);
  return log_radius;
}

}  // namespace

bool is_simple(const Connectivity& part, const std::vector<double>& field, int corner) {
  // it may if its neighbors of one side follow each other around it, and those of the other too
  bool on_border;
  const int changes = changes_around(part, field, corner, on_border);
  return changes == (on_border ? 1 : 2);
}

void reach_holes(const FilledDisk& disk, const Connectivity& part, std::vector<double>& field) {
  const int n = disk.part_vertices;
  const std::vector<Tri>& tris = disk.tris;
  const std::vector<int> corner = corners_of(disk);
  std::vector<int> from(n, -1), seen, path, ring;
  std::vector<double> distance(n, HUGE_VAL);
  std::vector<char> on_border(n, 0);
  for (int h = 0; h < 3 * disk.part_tris; ++h)
    if (part.is_border(h)) on_border[origin(tris, h)] = on_border[target(tris, h)] = 1;
  for (std::size_t f = 0; f + 1 < disk.fan_begin.size(); ++f) {
    ring.clear();
    for (int t = disk.fan_begin[f]; t < disk.fan_begin[f + 1]; ++t) ring.push_back(tris[t][0]);
    const bool side = field[ring[0]] > 0;
    if (std::any_of(ring.begin(), ring.end(), [&](int v) { return (field[v] > 0) != side; })) continue;
    for (int v : seen) distance[v] = HUGE_VAL;
    seen = ring;
    for (int v : ring) distance[v] = 0, from[v] = -1;
    int last = -1;  // of the path: the first vertex with a neighbor on the other side
    shortest_paths(ring, distance, [&](int v, auto reach) {
      for_each_neighbor(tris, part.opposite, corner[v], [&](int w) {
        if ((field[w] > 0) != side)
          last = v;
        else if (!on_border[w] && reach(w, distance[v] + norm(disk.points[w] - disk.points[v])))
          from[w] = v, seen.push_back(w);
      });
      return last < 0;
    });
    if (last < 0) continue;
    path.clear();
    bool cuts_open = true;
    for (int v = last; v >= 0 && cuts_open; v = from[v]) {
      bool border;
      cuts_open = changes_around(part, field, corner[v], border) == 2;
      if (cuts_open) {
        field[v] = -field[v];
        path.push_back(v);
      }
    }
    if (!cuts_open)
      for (int v : path) field[v] = -field[v];
  }
}

Branches find_branches(const FilledDisk& disk, const std::vector<Level>& levels) {
  const int n = disk.part_vertices;
  constexpr double width = 0.5;  // of a ring, in radii of the tube
  Branches branches;
  branches.ring.assign(n, -1);
  branches.between.assign(n, 0);
  std::vector<double> log_radius(n, 0), weight(n, 0), image, area, distance;
  std::vector<int> nearest, first, last;
  for (const Level& level : levels) {
    std::vector<Vec2> stops;
    for (int c : level.children) stops.push_back(levels[c].center);
    for (int h : level.holes) stops.push_back(level.uv[h]);
    if (stops.empty()) stops.push_back(middle_of(disk, level));
    image.assign(level.vertex.size(), 0);
    area.assign(level.vertex.size(), 0);
    for (std::size_t i = 0; i < level.tris.size(); ++i) {
      if (level.tris[i] >= disk.part_tris) continue;
      const Tri& c = level.corners[i];
      const double in_plane =
          std::abs(cross(level.uv[c[1]] - level.uv[c[0]], level.uv[c[2]] - level.uv[c[0]]));
      const double in_space = norm(area_vector(disk, level.tris[i]));
      for (int k : c) image[k] += in_plane, area[k] += in_space;
    }
    distance.assign(level.vertex.size(), 0);
    nearest.assign(level.vertex.size(), 0);
    first.assign(stops.size(), INT_MAX);
    last.assign(stops.size(), INT_MIN);
    for (std::size_t k = 0; k < level.vertex.size(); ++k) {
      double square = HUGE_VAL;
      for (std::size_t s = 0; s < stops.size(); ++s)
        if (double d = dot(level.uv[k] - stops[s], level.uv[k] - stops[s]); d < square) {
          square = d;
          nearest[k] = (int)s;
        }
      distance[k] = 0.5 * std::log(std::clamp(square, 1e-300, 1e300));  // at no stop if it has no place
      const int v = level.vertex[k], ring = (int)std::floor(distance[k] / width);
      if (v >= n) continue;
      first[nearest[k]] = std::min(first[nearest[k]], ring);
      last[nearest[k]] = std::max(last[nearest[k]], ring + 1);
      if (!(image[k] > 0) || !(area[k] > 0)) continue;
      log_radius[v] += area[k] * (distance[k] + 0.5 * std::log(area[k] / image[k]));
      weight[v] += area[k];
    }
    for (std::size_t s = 0; s < stops.size(); ++s) {
      if (last[s] < first[s]) continue;
      const int rings = last[s] - first[s] + 1;
      first[s] -= branches.rings;  // from here on, what to subtract from a ring's number
      branches.rings += rings;
    }
    for (std::size_t k = 0; k < level.vertex.size(); ++k) {
      const int v = level.vertex[k];
      if (v >= n || branches.ring[v] >= 0) continue;
      const double at = distance[k] / width, ring = std::floor(at);
      branches.ring[v] = (int)ring - first[nearest[k]];
      branches.between[v] = at - ring;
    }
  }
  for (int& ring : branches.ring)  // what no level has is a branch of its own
    if (ring < 0) ring = branches.rings;
  branches.rings += 2;
  branches.radius = smooth_radius(disk, std::move(log_radius), weight);
  return branches;
}

namespace {

/// M / r^2 + K: around a tube it leaves, applied twice, a third of the first harmonic and a fifteenth of the
/// second. `mass` receives the diagonal of M / r^2.
Factorization<double> make_smoother(const FilledDisk& disk, const Branches& branches,
                                    std::vector<double>& mass) {
  constexpr double conductance = 0.7;
  const int n = disk.part_vertices;
  const std::vector<Tri>& tris = disk.tris;
  mass.assign(n, 0);
  for (int t = 0; t < disk.part_tris; ++t) {
    const double third = norm(area_vector(disk, t)) / 6;
    for (int v : tris[t]) mass[v] += third;
  }
  for (int v = 0; v < n; ++v) mass[v] /= branches.radius[v] * branches.radius[v];
  Laplacian matrix(mass);
  matrix.reserve(3 * disk.part_tris);
  for (int h = 0; h < 3 * disk.part_tris; ++h) {
    const int a = origin(tris, h), b = target(tris, h);
    matrix.add_edge(a, b, conductance * disk.weights[h]);
  }
  return matrix.factorize();
}

/// Subtracts from each vertex the mean over its ring.
void subtract_section(const Branches& branches, const std::vector<double>& mass, std::vector<double>& x) {
  std::vector<double> sum(branches.rings, 0), weight(branches.rings, 0);
  for (std::size_t v = 0; v < x.size(); ++v)
    for (int i : {0, 1}) {
      const int ring = branches.ring[v] + i;
      const double w = mass[v] * (i ? branches.between[v] : 1 - branches.between[v]);
      sum[ring] += w * x[v];
      weight[ring] += w;
    }
  for (int r = 0; r < branches.rings; ++r)
    if (weight[r] > 0) sum[r] /= weight[r];
  for (std::size_t v = 0; v < x.size(); ++v)
    x[v] -= std::lerp(sum[branches.ring[v]], sum[branches.ring[v] + 1], branches.between[v]);
}

/// Gives the vertices the sides of `level`, as far as the topology lets it; returns how many changed.
int adopt_level(const Connectivity& part, const std::vector<int>& corner, const std::vector<double>& level,
                std::vector<double>& field) {
  const int n = (int)field.size();
  std::vector<int> changes, rest;
  for (int v = 0; v < n; ++v)
    if ((level[v] > 0) != (field[v] > 0)) changes.push_back(v);
  int flipped = 0;
  for (std::size_t before = 0; changes.size() != before;) {  // from the level inwards
    before = changes.size();
    rest.clear();
    for (int v : changes)
      if (is_simple(part, field, corner[v])) {
        field[v] = -field[v];
        ++flipped;
      } else {
        rest.push_back(v);
      }
    changes.swap(rest);
  }
  // a vertex that has to stay on its side is passed closely
  constexpr double close = 1e-2, least = 1e-12;
  for (int v = 0; v < n; ++v) {
    const double size = std::abs(level[v]);
    field[v] = std::copysign((level[v] > 0) == (field[v] > 0) ? std::max(size, least) : close * size + least,
                             field[v]);
  }
  return flipped;
}

}  // namespace

void balance_sides(const FilledDisk& disk, const Connectivity& part, const Branches& branches,
                   std::vector<double>& field, int rounds) {
  const int n = disk.part_vertices;
  const std::vector<int> corner = corners_of(disk);
  std::vector<double> mass, level(n);
  const Factorization<double> smoother = make_smoother(disk, branches, mass);
  auto smooth = [&] {
    for (int v = 0; v < n; ++v) level[v] *= mass[v];
    smoother.solve(level);
  };
  auto take_sides = [&] {
    for (int v = 0; v < n; ++v) level[v] = field[v] > 0 ? 1 : -1;
  };
  auto settle = [&] {
    for (int round = 0, flipped = n; round < rounds && flipped > n / 1000; ++round) {
      take_sides();
      subtract_section(branches, mass, level);
      smooth();
      smooth();
      flipped = adopt_level(part, corner, level, field);
    }
  };
  settle();
  take_sides();
  smooth();
  if (drop_hairs(disk.tris, disk.part_tris, level, field)) settle();
}

}  // namespace meshpipe
