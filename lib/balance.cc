// SPDX-License-Identifier: BSD-3-Clause
#include "lib/balance.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>

#include "lib/sparse.h"

namespace meshpipe {

namespace {

/// Strips so thin that the smoothed sides deny them, as on the way to a hole that lies out of the way, change
/// sides: the hole is then in the other half as a whole. A strip that holds larger pieces of its side
/// together stays. Returns whether there was one.
bool drop_hairs(const std::vector<Tri>& tris, int n_tris, const std::vector<double>& smoothed,
                std::vector<double>& field) {
  constexpr double deny = 0.4;
  const int n = (int)field.size();
  std::vector<int> parent(n), size(n, 0);
  std::iota(parent.begin(), parent.end(), 0);
  auto root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  auto is_thin = [&](int v) { return (field[v] > 0 ? smoothed[v] : -smoothed[v]) < -deny; };
  std::vector<std::pair<int, int>> touching;  // (thin vertex, vertex of its side that is not)
  for (int h = 0; h < 3 * n_tris; ++h) {
    int a = origin(tris, h), b = target(tris, h);
    if ((field[a] > 0) != (field[b] > 0)) continue;
    if (is_thin(a) == is_thin(b)) {
      a = root(a), b = root(b);
      parent[std::max(a, b)] = std::min(a, b);
    } else {
      touching.push_back(is_thin(a) ? std::pair(a, b) : std::pair(b, a));
    }
  }
  for (int v = 0; v < n; ++v) ++size[root(v)];
  for (auto& [thin, piece] : touching) thin = root(thin), piece = root(piece);
  std::erase_if(touching, [&](auto& p) { return size[p.second] <= size[p.first]; });
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  std::vector<char> holds(n, 0);
  for (std::size_t i = 1; i < touching.size(); ++i)
    if (touching[i].first == touching[i - 1].first) holds[touching[i].first] = 1;
  bool any = false;
  std::vector<char> drop(n);
  for (int v = 0; v < n; ++v) any |= drop[v] = is_thin(v) && !holds[root(v)];
  for (int v = 0; v < n; ++v)
    if (drop[v]) field[v] = -field[v];
  return any;
}

}  // namespace

namespace {

/// How often the side changes from one neighbour of the vertex to the next; sets `on_border`.
int changes_around(const std::vector<Tri>& tris, const std::vector<int>& opposite,
                   const std::vector<double>& field, int corner, bool& on_border) {
  const auto positive = [&](int v) { return field[v] > 0; };
  int changes = 0, h = corner;
  do {  // counter-clockwise over the triangles of the vertex; h leaves it
    changes += positive(target(tris, h)) != positive(origin(tris, prev(h)));
    h = opposite[prev(h)];
  } while (h >= 0 && h != corner);
  on_border = h != corner;
  if (!on_border) return changes;
  for (h = opposite[corner]; h >= 0; h = opposite[h]) {
    h = next(h);
    changes += positive(target(tris, h)) != positive(origin(tris, prev(h)));
  }
  return changes;
}

}  // namespace

bool is_simple(const std::vector<Tri>& tris, const std::vector<int>& opposite,
               const std::vector<double>& field, int corner) {
  // it may if its neighbours of one side follow each other around it, and those of the other too
  bool on_border;
  const int changes = changes_around(tris, opposite, field, corner, on_border);
  return changes == (on_border ? 1 : 2);
}

void reach_holes(const FilledDisk& disk, const std::vector<int>& opposite, std::vector<double>& field) {
  const int n = disk.part_vertices;
  const std::vector<Tri>& tris = disk.tris;
  std::vector<int> corner(n, -1), from(n, -1), seen, path;
  std::vector<double> distance(n, HUGE_VAL);
  std::vector<char> on_border(n, 0);
  for (int h = 0; h < 3 * disk.part_tris; ++h) {
    corner[origin(tris, h)] = h;
    if (opposite[h] < 0) on_border[origin(tris, h)] = on_border[target(tris, h)] = 1;
  }
  using Item = std::pair<double, int>;
  for (std::size_t f = 0; f + 1 < disk.fan_begin.size(); ++f) {
    const int begin = disk.fan_begin[f], end = disk.fan_begin[f + 1];
    const bool side = field[tris[begin][0]] > 0;
    bool whole = true;
    for (int t = begin; t < end; ++t) whole &= (field[tris[t][0]] > 0) == side;
    if (!whole) continue;
    for (int v : seen) distance[v] = HUGE_VAL;
    seen.clear();
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    auto reach = [&](int v, double d, int u) {
      if (d >= distance[v]) return;
      if (distance[v] == HUGE_VAL) seen.push_back(v);
      distance[v] = d;
      from[v] = u;
      queue.push({d, v});
    };
    for (int t = begin; t < end; ++t) reach(tris[t][0], 0, -1);
    int last = -1;  // of the path: the first vertex with a neighbour on the other side
    while (!queue.empty() && last < 0) {
      const double d = queue.top().first;
      const int v = queue.top().second;
      queue.pop();
      if (d > distance[v]) continue;
      auto visit = [&](int w) {
        if ((field[w] > 0) != side)
          last = v;
        else if (!on_border[w])
          reach(w, d + norm(disk.points[w] - disk.points[v]), v);
      };
      int h = corner[v];
      do {
        visit(target(tris, h));
        visit(origin(tris, prev(h)));
        h = opposite[prev(h)];
      } while (h >= 0 && h != corner[v]);
      if (h < 0)
        for (h = opposite[corner[v]]; h >= 0; h = opposite[h]) {
          h = next(h);
          visit(target(tris, h));
        }
    }
    if (last < 0) continue;
    path.clear();
    bool cuts_open = true;
    for (int v = last; v >= 0 && cuts_open; v = from[v]) {
      bool border;
      cuts_open = changes_around(tris, opposite, field, corner[v], border) == 2;
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
    for (int c : level.children) stops.push_back(levels[c].centre);
    for (int h : level.holes) stops.push_back(level.uv[h]);
    if (stops.empty()) stops.push_back(middle_of(disk, level));
    image.assign(level.vertex.size(), 0);
    area.assign(level.vertex.size(), 0);
    for (std::size_t i = 0; i < level.tris.size(); ++i) {
      if (level.tris[i] >= disk.part_tris) continue;
      const Tri &t = disk.tris[level.tris[i]], &c = level.corners[i];
      const double in_plane =
          std::abs(cross(level.uv[c[1]] - level.uv[c[0]], level.uv[c[2]] - level.uv[c[0]]));
      const double in_space = norm(area_vector(disk.points[t[0]], disk.points[t[1]], disk.points[t[2]]));
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
  std::vector<double> length(n, 0), sum(n);
  std::vector<int> count(n, 0);
  for (int h = 0; h < 3 * disk.part_tris; ++h) {
    const int a = origin(disk.tris, h), b = target(disk.tris, h);
    const double l = norm(disk.points[b] - disk.points[a]);
    length[a] += l, length[b] += l;
    ++count[a], ++count[b];
  }
  for (int v = 0; v < n; ++v) {
    const double edge = std::log(std::max(length[v] / std::max(count[v], 1), 1e-300));
    log_radius[v] = weight[v] > 0 ? std::max(log_radius[v] / weight[v], edge) : edge;
  }
  // levels do not meet smoothly
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
  branches.radius = std::move(log_radius);
  return branches;
}

void balance_sides(const FilledDisk& disk, const std::vector<int>& opposite, const Branches& branches,
                   const std::vector<char>& crease, std::vector<double>& field, int rounds) {
  const int n = disk.part_vertices;
  const std::vector<Tri>& tris = disk.tris;  // only those of the part are read: others are no one's opposite
  std::vector<double> mass(n, 0);
  std::vector<int> corner(n, -1);
  for (int t = 0; t < disk.part_tris; ++t) {
    const Tri& c = tris[t];
    const double third = norm(area_vector(disk.points[c[0]], disk.points[c[1]], disk.points[c[2]])) / 6;
    for (int k = 0; k < 3; ++k) {
      mass[c[k]] += third;
      corner[c[k]] = 3 * t + k;
    }
  }
  for (int v = 0; v < n; ++v) mass[v] /= branches.radius[v] * branches.radius[v];
  // M / r^2 + K: around a tube the smoother, applied twice, leaves a third of the first harmonic and a
  // fifteenth of the second
  constexpr double conductance = 0.7, across_crease = 0.1;
  std::vector<char> on_crease(n, 0);
  for (std::size_t h = 0; h < crease.size(); ++h)
    if (crease[h]) on_crease[origin(tris, h)] = on_crease[target(tris, h)] = 1;
  std::vector<Entry<double>> matrix;
  matrix.reserve(3 * disk.part_tris + n);
  std::vector<double> diagonal = mass;
  for (int h = 0; h < 3 * disk.part_tris; ++h) {
    const int a = origin(tris, h), b = target(tris, h);
    const bool leaves_crease = on_crease[a] + on_crease[b] == 1;
    const double k = conductance * disk.weights[h] * (leaves_crease ? across_crease : 1);
    diagonal[a] += k, diagonal[b] += k;
    matrix.push_back({std::max(a, b), std::min(a, b), -k});
  }
  for (int v = 0; v < n; ++v) matrix.push_back({v, v, diagonal[v]});
  const Factorisation<double> smoother(n, std::move(matrix));
  auto smooth = [&](std::vector<double>& x) {
    for (int v = 0; v < n; ++v) x[v] *= mass[v];
    smoother.solve(x);
  };
  std::vector<double> sum(branches.rings), weight(branches.rings);
  auto subtract_section = [&](std::vector<double>& x) {
    std::fill(sum.begin(), sum.end(), 0);
    std::fill(weight.begin(), weight.end(), 0);
    for (int v = 0; v < n; ++v)
      for (int i : {0, 1}) {
        const int ring = branches.ring[v] + i;
        const double w = mass[v] * (i ? branches.between[v] : 1 - branches.between[v]);
        sum[ring] += w * x[v];
        weight[ring] += w;
      }
    for (int r = 0; r < branches.rings; ++r)
      if (weight[r] > 0) sum[r] /= weight[r];
    for (int v = 0; v < n; ++v)
      x[v] -= std::lerp(sum[branches.ring[v]], sum[branches.ring[v] + 1], branches.between[v]);
  };

  std::vector<double> level(n);
  std::vector<int> changes, rest;
  // gives the vertices the sides of `level`, as far as the topology lets it; returns how many changed
  auto adopt_level = [&] {
    changes.clear();
    for (int v = 0; v < n; ++v)
      if ((level[v] > 0) != (field[v] > 0)) changes.push_back(v);
    int flipped = 0;
    for (std::size_t before = 0; changes.size() != before;) {  // from the level inwards
      before = changes.size();
      rest.clear();
      for (int v : changes)
        if (is_simple(tris, opposite, field, corner[v])) {
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
      field[v] = std::copysign(
          (level[v] > 0) == (field[v] > 0) ? std::max(size, least) : close * size + least, field[v]);
    }
    return flipped;
  };
  auto take_sides = [&] {
    for (int v = 0; v < n; ++v) level[v] = field[v] > 0 ? 1 : -1;
  };
  auto settle = [&] {
    for (int round = 0, flipped = n; round < rounds && flipped > n / 1000; ++round) {
      take_sides();
      subtract_section(level);
      smooth(level);
      smooth(level);
      flipped = adopt_level();
    }
  };
  settle();
  take_sides();
  smooth(level);
  if (drop_hairs(tris, disk.part_tris, level, field)) settle();
}

}  // namespace meshpipe
