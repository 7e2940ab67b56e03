// SPDX-License-Identifier: BSD-3-Clause
#include "lib/forecast.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "lib/sparse.h"

namespace meshpipe {
namespace {

using std::numbers::pi;

struct Loop {
  std::vector<int> half_edges;
  double length = 0;
};

double edge_length(const Mesh& mesh, int h) {
  return norm(mesh.points[target(mesh.tris, h)] - mesh.points[origin(mesh.tris, h)]);
}

/// The border half-edges of a region as loops, each in order.
template <class Inside>
std::vector<Loop> loops_of(const Mesh& mesh, const std::vector<int>& opposite, std::vector<int> border,
                           Inside inside) {
  std::sort(border.begin(), border.end());
  std::vector<char> seen(border.size(), 0);
  std::vector<Loop> loops;
  for (std::size_t i = 0; i < border.size(); ++i) {
    if (seen[i]) continue;
    Loop loop;
    for (std::size_t k = i; !seen[k];) {
      seen[k] = 1;
      loop.half_edges.push_back(border[k]);
      loop.length += edge_length(mesh, border[k]);
      int g = next(border[k]);
      while (opposite[g] >= 0 && inside(opposite[g] / 3)) g = next(opposite[g]);
      k = std::lower_bound(border.begin(), border.end(), g) - border.begin();
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

/// The edges that a cell has in common with another, or with the rim.
struct Contact {
  double length = 0;
  Vec3 middle,
      across;  // their first moment; the sum of their normals outward in the triangle, of their length
  void add(const Mesh& mesh, int h) {
    const Vec3 p = mesh.points[origin(mesh.tris, h)], q = mesh.points[target(mesh.tris, h)];
    const double l = norm(q - p);
    middle = middle + l * lerp(p, q, 0.5);
    length += l;
    across = across + cross(q - p, normalized(area_vector(p, q, mesh.points[origin(mesh.tris, prev(h))])));
  }
  Vec3 place() const { return (1 / length) * middle; }
  /// Its width for a flow in this direction: a ragged contact conducts like a straight one.
  double width(Vec3 direction) const { return std::max(dot(across, normalized(direction)), 0.1 * length); }
};

bool cross_each_other(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return cross(b - a, c - a) * cross(b - a, d - a) < 0 && cross(d - c, a - c) * cross(d - c, b - c) < 0;
}

/// How often the polygon of a loop with these turns (at the edges' origins) and its own lengths crosses
/// itself; looked at with some hundred corners, for what is smaller is the model's coarseness.
int outline_crossings(const Mesh& mesh, const Loop& rim, const std::vector<double>& turn) {
  constexpr std::size_t corners = 240;
  const std::size_t n = rim.half_edges.size();
  std::vector<Vec2> all{{0, 0}}, polygon;
  std::vector<double> along{0};
  double heading = 0;
  for (std::size_t i = 0; i < n; ++i) {
    heading += turn[i];
    const double l = edge_length(mesh, rim.half_edges[i]);
    all.push_back(all.back() + l * Vec2{std::cos(heading), std::sin(heading)});
    along.push_back(along.back() + l);
  }
  const Vec2 gap = all.back();  // it closes but for discretisation
  for (std::size_t i = 0, next = 0; i < n; ++i)
    if (along[i] * corners >= (double)next * rim.length) {
      polygon.push_back(all[i] - (along[i] / rim.length) * gap);
      next = (std::size_t)(along[i] * corners / rim.length) + 1;
    }
  const std::size_t m = polygon.size();
  int crossings = 0;
  for (std::size_t i = 0; i + 2 < m; ++i)
    for (std::size_t j = i + 2; j < m; ++j)
      if ((i > 0 || j + 1 < m) &&
          cross_each_other(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % m]))
        ++crossings;
  return crossings;
}

}  // namespace

Forecaster::Forecaster(const Mesh& mesh, const std::vector<int>& opposite)
    : mesh_(mesh), opposite_(opposite) {
  grow_cells();
  spread_curvature();
}

/// Breadth first to an equal share of the area each.
void Forecaster::grow_cells() {
  const int n = (int)mesh_.tris.size(), wanted = std::clamp(n / 20, 8, 2000);
  double total = 0;
  for (const Tri& v : mesh_.tris) {
    area_.push_back(0.5 * norm(area_vector(mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]])));
    total += area_.back();
  }
  cell_.assign(n, -1);
  std::vector<int> front;
  for (int seed = 0; seed < n; ++seed) {
    if (cell_[seed] >= 0) continue;
    front.assign(1, seed);
    cell_[seed] = n_cells_;
    double area = 0;
    std::size_t at = 0;
    for (; at < front.size() && area < total / wanted; ++at) {
      area += area_[front[at]];
      for (int h = 3 * front[at]; h < 3 * front[at] + 3; ++h)
        if (int o = opposite_[h]; o >= 0 && cell_[o / 3] < 0) {
          cell_[o / 3] = n_cells_;
          front.push_back(o / 3);
        }
    }
    for (; at < front.size(); ++at) cell_[front[at]] = -1;
    ++n_cells_;
  }
  // what is left between the others joins one of them
  std::vector<double> size(n_cells_, 0);
  for (int t = 0; t < n; ++t) size[cell_[t]] += area_[t];
  for (bool again = true; again;) {
    again = false;
    for (int t = 0; t < n; ++t) {
      if (size[cell_[t]] >= 0.3 * total / wanted) continue;
      for (int h = 3 * t; h < 3 * t + 3; ++h)
        if (int o = opposite_[h]; o >= 0 && size[cell_[o / 3]] >= 0.3 * total / wanted) {
          cell_[t] = cell_[o / 3];
          again = true;
          break;
        }
    }
  }
  for (int h = 0; h < 3 * n; ++h)
    if (int o = opposite_[h]; o >= 0 && cell_[h / 3] < cell_[o / 3]) crossing_.push_back(h);
  std::sort(crossing_.begin(), crossing_.end(), [&](int g, int h) {
    return std::tuple(cell_[g / 3], cell_[opposite_[g] / 3], g) <
           std::tuple(cell_[h / 3], cell_[opposite_[h] / 3], h);
  });
}

/// The angle defect of an inner vertex goes to its triangles by their share of its angles.
void Forecaster::spread_curvature() {
  const int n = (int)mesh_.tris.size();
  round_.assign(mesh_.points.size(), 0);
  on_border_.assign(mesh_.points.size(), 0);
  angle_.resize(3 * n);
  for (int h = 0; h < 3 * n; ++h) {
    const Vec3 p = mesh_.points[origin(mesh_.tris, h)];
    angle_[h] = angle(mesh_.points[target(mesh_.tris, h)] - p, mesh_.points[origin(mesh_.tris, prev(h))] - p);
    round_[origin(mesh_.tris, h)] += angle_[h];
    if (opposite_[h] < 0) on_border_[origin(mesh_.tris, h)] = on_border_[target(mesh_.tris, h)] = 1;
  }
  curvature_.assign(n, 0);
  for (int h = 0; h < 3 * n; ++h)
    if (int v = origin(mesh_.tris, h); !on_border_[v] && round_[v] > 0)
      curvature_[h / 3] += (2 * pi / round_[v] - 1) * angle_[h];
}

Forecast Forecaster::of(const std::vector<int>& label, int a, int b, const std::vector<int>& border) const {
  auto inside = [&](int t) { return label[t] == a || label[t] == b; };
  std::vector<double> area(n_cells_, 0), charge(n_cells_, 0);
  std::vector<Vec3> middle(n_cells_);
  for (int t = 0; t < (int)label.size(); ++t) {
    if (!inside(t)) continue;
    const int c = cell_[t];
    const Tri& v = mesh_.tris[t];
    area[c] += area_[t];
    charge[c] -= curvature_[t];
    middle[c] = middle[c] + (area_[t] / 3) * (mesh_.points[v[0]] + mesh_.points[v[1]] + mesh_.points[v[2]]);
  }
  std::vector<int> unknown(n_cells_, -1), cells;
  for (int c = 0; c < n_cells_; ++c)
    if (area[c] > 0) {
      unknown[c] = (int)cells.size();
      cells.push_back(c);
      middle[c] = (1 / area[c]) * middle[c];
    }
  // the curvature of a vertex on the border is in its turn instead: the angle missing to a half turn, in the
  // order of the loop's edges at their origins
  std::vector<Loop> loops = loops_of(mesh_, opposite_, border, inside);
  auto turns_of = [&](const Loop& loop) {
    std::vector<double> turn;
    for (int h : loop.half_edges) {
      const int v = origin(mesh_.tris, h);
      double fan = angle_[h];
      for (int g = prev(h); opposite_[g] >= 0 && inside(opposite_[g] / 3); g = prev(opposite_[g]))
        fan += angle_[opposite_[g]];
      if (!on_border_[v] && round_[v] > 0) charge[cell_[h / 3]] += (2 * pi / round_[v] - 1) * fan;
      turn.push_back(pi - fan);
    }
    return turn;
  };
  std::size_t longest = 0;
  for (std::size_t l = 0; l < loops.size(); ++l)
    if (loops[l].length > loops[longest].length) longest = l;
  std::vector<double> turn;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const std::vector<double> here = turns_of(loops[l]);
    if (l == longest) {
      turn = here;
      continue;
    }
    // a hole turns once round the other way, in all
    for (std::size_t i = 0; i < here.size(); ++i) {
      const int h = loops[l].half_edges[i];
      charge[cell_[h / 3]] -= here[i] + 2 * pi * edge_length(mesh_, h) / loops[l].length;
    }
  }

  const Loop& rim = loops[longest];
  std::vector<Contact> with_rim(n_cells_);
  for (int h : rim.half_edges) with_rim[cell_[h / 3]].add(mesh_, h);
  std::vector<double> rim_weight(n_cells_, 0), diagonal(cells.size(), 0);
  std::vector<Entry<double>> entries;
  for (int c : cells)
    if (with_rim[c].length > 0) {
      const Vec3 way = with_rim[c].place() - middle[c];
      diagonal[unknown[c]] = rim_weight[c] =
          with_rim[c].width(way) / std::max(norm(way), 0.1 * std::sqrt(area[c]));
    }
  for (std::size_t i = 0, j; i < crossing_.size(); i = j) {
    const int c = cell_[crossing_[i] / 3], d = cell_[opposite_[crossing_[i]] / 3];
    Contact contact;
    for (j = i; j < crossing_.size(); ++j) {
      const int h = crossing_[j], o = opposite_[h];
      if (cell_[h / 3] != c || cell_[o / 3] != d) break;
      if (inside(h / 3) && inside(o / 3)) contact.add(mesh_, h);
    }
    if (!(contact.length > 0)) continue;
    const Vec3 m = contact.place();
    const double way = norm(m - middle[c]) + norm(m - middle[d]);
    const double w =
        contact.width(middle[d] - middle[c]) / std::max(way, 0.1 * std::sqrt(std::min(area[c], area[d])));
    diagonal[unknown[c]] += w;
    diagonal[unknown[d]] += w;
    entries.push_back({std::max(unknown[c], unknown[d]), std::min(unknown[c], unknown[d]), -w});
  }
  for (int i = 0; i < (int)cells.size(); ++i) entries.push_back({i, i, diagonal[i]});
  std::vector<double> scale;  // logarithm of the length scale, 0 on the rim
  for (int c : cells) scale.push_back(charge[c]);
  Factorisation<double>((int)cells.size(), entries).solve(scale);

  Forecast forecast;
  std::vector<int> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::tie(scale[i], i) < std::tie(scale[j], j); });
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  double below = 0, low = scale[order.front()], high = scale[order.back()];
  for (int i : order) {
    if (below < 0.01 * total) low = scale[i];
    if (below < 0.99 * total) high = scale[i];
    below += area[cells[i]];
  }
  forecast.unevenness = std::exp(2 * (high - low));
  const std::size_t n = rim.half_edges.size();
  for (std::size_t i = 0; i < n; ++i) {
    const int h = rim.half_edges[i], c = cell_[h / 3];
    const double flux = -rim_weight[c] * scale[unknown[c]] * edge_length(mesh_, h) / with_rim[c].length;
    turn[i] += flux / 2;
    turn[(i + 1) % n] += flux / 2;
  }
  forecast.crossings = outline_crossings(mesh_, rim, turn);
  return forecast;
}

}  // namespace meshpipe
