// SPDX-License-Identifier: BSD-3-Clause
#include "lib/balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>

#include "lib/sparse.h"

namespace meshpipe {

namespace {

/// Gradients of the three linear shape functions of a triangle, times twice its area.
std::array<Vec3, 3> gradients(const FilledDisk& disk, int t, double& twice_area) {
  const Tri& c = disk.tris[t];
  const Vec3 a = disk.points[c[0]], b = disk.points[c[1]], d = disk.points[c[2]];
  const Vec3 n = area_vector(a, b, d);
  twice_area = norm(n);
  if (!(twice_area > 0)) return {};
  const Vec3 unit = (1 / twice_area) * n;
  return {cross(unit, d - b), cross(unit, a - d), cross(unit, b - a)};
}

Vec3 direction_of_descent(const FilledDisk& disk, int t, const double (&value)[3]) {
  double twice_area;
  const std::array<Vec3, 3> g = gradients(disk, t, twice_area);
  const Vec3 d = value[0] * g[0] + value[1] * g[1] + value[2] * g[2];
  const double length = norm(d);
  return length > 0 ? (-1 / length) * d : Vec3{};
}

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
  for (int h = 0; h < 3 * disk.part_tris; ++h) corner[origin(tris, h)] = h;
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
    int reached = -1;
    while (!queue.empty() && reached < 0) {
      const double d = queue.top().first;
      const int v = queue.top().second;
      queue.pop();
      if (d > distance[v]) continue;
      if ((field[v] > 0) != side) reached = v;
      auto visit = [&](int w) { reach(w, d + norm(disk.points[w] - disk.points[v]), v); };
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
    if (reached < 0) continue;
    path.clear();
    bool cuts_open = true;
    for (int v = from[reached]; v >= 0 && cuts_open; v = from[v]) {
      bool on_border;
      const int changes = changes_around(tris, opposite, field, corner[v], on_border);
      cuts_open = changes == 2 && on_border == (from[v] < 0);
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
  Branches branches;
  branches.axis.resize(disk.part_tris);
  std::vector<double> log_radius(n, 0), weight(n, 0), image, area;
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
      const Vec2 middle = (1. / 3) * (level.uv[c[0]] + level.uv[c[1]] + level.uv[c[2]]);
      const Vec2 stop = *std::min_element(stops.begin(), stops.end(), [&](Vec2 a, Vec2 b) {
        return dot(a - middle, a - middle) < dot(b - middle, b - middle);
      });
      double log_distance[3];
      for (int k = 0; k < 3; ++k) log_distance[k] = std::log(std::max(norm(level.uv[c[k]] - stop), 1e-300));
      branches.axis[level.tris[i]] = direction_of_descent(disk, level.tris[i], log_distance);
    }
    for (std::size_t k = 0; k < level.vertex.size(); ++k) {
      const int v = level.vertex[k];
      if (v >= n || !(image[k] > 0) || !(area[k] > 0)) continue;
      double nearest = HUGE_VAL;
      for (Vec2 s : stops) nearest = std::min(nearest, dot(level.uv[k] - s, level.uv[k] - s));
      log_radius[v] += 0.5 * area[k] * std::log(std::max(nearest, 1e-300) * area[k] / image[k]);
      weight[v] += area[k];
    }
  }
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
                   std::vector<double>& field, int rounds) {
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
  // M / r^2 + K, K with conductances around and along the branch
  auto factorise = [&](double around, double along) {
    std::vector<Entry<double>> matrix;
    matrix.reserve(3 * disk.part_tris + n);
    std::vector<double> diagonal = mass;
    for (int t = 0; t < disk.part_tris; ++t) {
      double twice;
      const std::array<Vec3, 3> g = gradients(disk, t, twice);
      const Vec3 d = branches.axis[t];
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, a = tris[t][i], b = tris[t][j];
        const double isotropic = -disk.weights[3 * t + i];
        double k = around * isotropic;
        if (along != around) {
          const double axial =
              twice > 0 ? std::clamp(dot(g[i], d) * dot(g[j], d) / (2 * twice), -100., 100.) : 0;
          k += (along - around) * axial;
        }
        k = std::min(k, 0.);
        diagonal[a] -= k, diagonal[b] -= k;
        matrix.push_back({std::max(a, b), std::min(a, b), k});
      }
    }
    for (int v = 0; v < n; ++v) matrix.push_back({v, v, diagonal[v]});
    return Factorisation<double>(n, matrix);
  };
  // around a tube the smoother, applied twice, leaves a third of the first harmonic and a fifteenth of the
  // second; the section's mean reaches less than half a radius along it
  const Factorisation<double> smoother = factorise(0.7, 0.7), section = factorise(4, 0.2);
  auto apply = [&](const Factorisation<double>& filter, std::vector<double>& x) {
    for (int v = 0; v < n; ++v) x[v] *= mass[v];
    filter.solve(x);
  };

  std::vector<double> level(n), again;
  std::vector<int> changes, rest;
  auto settle = [&](int most_rounds) {
    for (int round = 0, flipped = n; round < most_rounds && flipped > n / 10000; ++round) {
      for (int v = 0; v < n; ++v) level[v] = field[v] > 0 ? 1 : -1;
      again = level;
      apply(section, again);
      for (int v = 0; v < n; ++v) level[v] -= again[v];
      apply(smoother, level);
      apply(smoother, level);
      changes.clear();
      for (int v = 0; v < n; ++v)
        if ((level[v] > 0) != (field[v] > 0)) changes.push_back(v);
      // from the level inwards, as far as the topology lets it
      flipped = 0;
      for (std::size_t before = 0; changes.size() != before;) {
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
    }
  };
  settle(rounds);
  for (int v = 0; v < n; ++v) level[v] = field[v] > 0 ? 1 : -1;
  apply(smoother, level);
  if (drop_hairs(tris, disk.part_tris, level, field)) settle(rounds);
}

}  // namespace meshpipe
