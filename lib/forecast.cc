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

void CellContact::add(const Mesh& mesh, int h) {
  const Vec3 p = mesh.points[origin(mesh.tris, h)], q = mesh.points[target(mesh.tris, h)];
  const double l = norm(q - p);
  middle = middle + l * lerp(p, q, 0.5);
  length += l;
  across = across + cross(q - p, normalized(area_vector(p, q, mesh.points[origin(mesh.tris, prev(h))])));
}

double CellContact::width(Vec3 direction) const {
  return std::max(dot(across, normalized(direction)), 0.1 * length);
}

Forecaster::Forecaster(const Mesh& mesh, const std::vector<int>& opposite)
    : mesh_(mesh), opposite_(opposite) {
  const int n = (int)mesh_.tris.size();
  for (const Tri& v : mesh_.tris)
    area_.push_back(0.5 * norm(area_vector(mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]])));
  cells_ = grow_cells(opposite_, area_, std::clamp(n / 20, std::min(8, n / 2), 2000));
  // the angle defect of an inner vertex goes to its triangles by their share of its angles
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
  start_.assign(cells_.n + 1, 0);
  for (int c : cells_.of) ++start_[c + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  member_.resize(n);
  std::vector<int> fill(start_.begin(), start_.end() - 1);
  for (int t = 0; t < n; ++t) member_[fill[cells_.of[t]]++] = t;
  for (int i = 0; i < (int)cells_.crossing.size(); ++i) {
    const int h = cells_.crossing[i];
    if (contact_.empty() || cells_.of[h / 3] != cells_.of[cells_.crossing[contact_.back().first] / 3] ||
        cells_.of[opposite_[h] / 3] != cells_.of[opposite_[cells_.crossing[contact_.back().first]] / 3])
      contact_.emplace_back().first = i;
    contact_.back().last = i + 1;
    contact_.back().add(mesh_, h);
  }
  for (int c = 0; c < cells_.n; ++c) whole_.push_back(gather(c, [](int) { return true; }));
}

template <class Inside>
Forecaster::Bulk Forecaster::gather(int cell, Inside inside) const {
  Bulk bulk;
  for (int i = start_[cell]; i < start_[cell + 1]; ++i) {
    const int t = member_[i];
    if (!inside(t)) continue;
    const Tri& v = mesh_.tris[t];
    bulk.area += area_[t];
    bulk.curvature += curvature_[t];
    bulk.middle =
        bulk.middle + (area_[t] / 3) * (mesh_.points[v[0]] + mesh_.points[v[1]] + mesh_.points[v[2]]);
  }
  return bulk;
}

Forecast Forecaster::of(const std::vector<int>& label, int a, int b, const std::vector<int>& border) const {
  auto inside = [&](int t) { return label[t] == a || label[t] == b; };
  // a cell is divided if the border runs inside it; the others are taken as they are
  std::vector<char> divided(cells_.n, 0);
  for (int h : border)
    if (int o = opposite_[h]; o >= 0 && cells_.of[h / 3] == cells_.of[o / 3]) divided[cells_.of[h / 3]] = 1;
  std::vector<double> area(cells_.n, 0), charge(cells_.n, 0);
  std::vector<Vec3> middle(cells_.n);
  std::vector<int> unknown(cells_.n, -1), cells;
  for (int c = 0; c < cells_.n; ++c) {
    if (!divided[c] && !inside(member_[start_[c]])) continue;
    const Bulk bulk = divided[c] ? gather(c, inside) : whole_[c];
    if (!(bulk.area > 0)) continue;
    unknown[c] = (int)cells.size();
    cells.push_back(c);
    area[c] = bulk.area;
    charge[c] = -bulk.curvature;
    middle[c] = (1 / bulk.area) * bulk.middle;
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
      if (!on_border_[v] && round_[v] > 0) charge[cells_.of[h / 3]] += (2 * pi / round_[v] - 1) * fan;
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
      charge[cells_.of[h / 3]] -= here[i] + 2 * pi * edge_length(mesh_, h) / loops[l].length;
    }
  }

  const Loop& rim = loops[longest];
  std::vector<CellContact> with_rim(cells_.n);
  for (int h : rim.half_edges) with_rim[cells_.of[h / 3]].add(mesh_, h);
  std::vector<double> rim_weight(cells_.n, 0), diagonal(cells.size(), 0);
  std::vector<Entry<double>> entries;
  for (int c : cells)
    if (with_rim[c].length > 0) {
      const Vec3 way = with_rim[c].place() - middle[c];
      diagonal[unknown[c]] = rim_weight[c] =
          with_rim[c].width(way) / std::max(norm(way), 0.1 * std::sqrt(area[c]));
    }
  for (const CellContact& both : contact_) {
    const int c = cells_.of[cells_.crossing[both.first] / 3];
    const int d = cells_.of[opposite_[cells_.crossing[both.first]] / 3];
    if (unknown[c] < 0 || unknown[d] < 0) continue;
    CellContact contact = both;
    if (divided[c] || divided[d]) {
      contact = {};
      for (int i = both.first; i < both.last; ++i)
        if (const int h = cells_.crossing[i]; inside(h / 3) && inside(opposite_[h] / 3))
          contact.add(mesh_, h);
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
  Factorisation<double>((int)cells.size(), std::move(entries)).solve(scale);

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
    const int h = rim.half_edges[i], c = cells_.of[h / 3];
    const double flux = -rim_weight[c] * scale[unknown[c]] * edge_length(mesh_, h) / with_rim[c].length;
    turn[i] += flux / 2;
    turn[(i + 1) % n] += flux / 2;
  }
  forecast.crossings = outline_crossings(mesh_, rim, turn);
  return forecast;
}

}  // namespace meshpipe
