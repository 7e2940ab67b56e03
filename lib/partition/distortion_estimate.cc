// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/distortion_estimate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "lib/core/connectivity.h"
#include "lib/numeric/laplacian.h"

namespace meshpipe {
namespace {

using std::numbers::pi;

struct Loop {
  std::vector<int> half_edges;
  double length = 0;
};

/// The border half-edges of a region as loops, each in order.
template <class Inside>
std::vector<Loop> loops_of(const Connectivity& mesh, std::vector<int> border, Inside inside) {
  std::sort(border.begin(), border.end());
  std::vector<char> seen(border.size(), 0);
  std::vector<Loop> loops;
  for (std::size_t i = 0; i < border.size(); ++i) {
    if (seen[i]) continue;
    Loop loop;
    for (std::size_t k = i; !seen[k];) {
      seen[k] = 1;
      loop.half_edges.push_back(border[k]);
      loop.length += mesh.length(border[k]);
      const int g = next_on_border(mesh.opposite, border[k], inside);
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
/// itself; drawn with some hundred corners, since what is smaller is the coarseness of the model.
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
  const Vec2 gap = all.back();  // it closes, except for discretization
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

/// The logarithm of the area scale at 99 % of the area, less that at 1 %. `scale`: half of it, per aggregate.
double spread_of(const std::vector<double>& scale, const std::vector<int>& members,
                 const std::vector<double>& area) {
  std::vector<int> order(scale.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::tie(scale[i], i) < std::tie(scale[j], j); });
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  double below = 0, low = scale[order.front()], high = scale[order.back()];
  for (int i : order) {
    if (below < 0.01 * total) low = scale[i];
    if (below < 0.99 * total) high = scale[i];
    below += area[members[i]];
  }
  return 2 * (high - low);
}

}  // namespace

void Contact::add(const Mesh& mesh, int h) {
  const Vec3 p = mesh.points[origin(mesh.tris, h)], q = mesh.points[target(mesh.tris, h)];
  const double l = norm(q - p);
  middle = middle + l * lerp(p, q, 0.5);
  length += l;
  across = across + cross(q - p, normalized(area_vector(p, q, mesh.points[origin(mesh.tris, prev(h))])));
}

double Contact::width(Vec3 direction) const {
  return std::max(dot(across, normalized(direction)), 0.1 * length);
}

/// The unknowns of one estimate, per aggregate.
struct DistortionModel::Region {
  std::vector<char> divided;  ///< the border runs inside it; the others are taken as they are
  std::vector<double> area, charge, rim_weight;
  std::vector<Vec3> middle;
  std::vector<int> unknown;   ///< number among the members, or -1
  std::vector<int> members;   ///< the aggregates in the region
  std::vector<double> scale;  ///< of members: logarithm of the length scale, 0 on the rim
};

DistortionModel::DistortionModel(const Connectivity& mesh) : mesh_(mesh.mesh), opposite_(mesh.opposite) {
  const int n = (int)mesh_.tris.size();
  for (int t = 0; t < n; ++t) area_.push_back(triangle_area(mesh_, t));
  aggregates_ = grow_aggregates(mesh, area_, std::clamp(n / 20, std::min(8, n / 2), 2000));
  // the angle defect of an inner vertex goes to its triangles by their share of its angles
  angle_sum_.assign(mesh_.points.size(), 0);
  on_border_.assign(mesh_.points.size(), 0);
  angle_.resize(3 * n);
  for (int h = 0; h < 3 * n; ++h) {
    const Vec3 p = mesh_.points[origin(mesh_.tris, h)];
    angle_[h] = angle(mesh_.points[target(mesh_.tris, h)] - p, mesh_.points[origin(mesh_.tris, prev(h))] - p);
    angle_sum_[origin(mesh_.tris, h)] += angle_[h];
    if (opposite_[h] < 0) on_border_[origin(mesh_.tris, h)] = on_border_[target(mesh_.tris, h)] = 1;
  }
  curvature_.assign(n, 0);
  for (int h = 0; h < 3 * n; ++h)
    if (int v = origin(mesh_.tris, h); !on_border_[v] && angle_sum_[v] > 0)
      curvature_[h / 3] += (2 * pi / angle_sum_[v] - 1) * angle_[h];
  const std::vector<int>& of = aggregates_.of;
  start_.assign(aggregates_.n + 1, 0);
  for (int g : of) ++start_[g + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  member_.resize(n);
  std::vector<int> fill(start_.begin(), start_.end() - 1);
  for (int t = 0; t < n; ++t) member_[fill[of[t]]++] = t;
  auto ends = [&](int i) {
    const int h = aggregates_.crossing[i];
    return std::pair(of[h / 3], of[opposite_[h] / 3]);
  };
  for (int i = 0; i < (int)aggregates_.crossing.size(); ++i) {
    if (contact_.empty() || ends(i) != ends(contact_.back().first)) contact_.emplace_back().first = i;
    contact_.back().last = i + 1;
    contact_.back().add(mesh_, aggregates_.crossing[i]);
  }
  for (int g = 0; g < aggregates_.n; ++g) whole_.push_back(gather(g, [](int) { return true; }));
}

template <class Inside>
DistortionModel::Moments DistortionModel::gather(int aggregate, Inside inside) const {
  Moments m;
  for (int i = start_[aggregate]; i < start_[aggregate + 1]; ++i) {
    const int t = member_[i];
    if (!inside(t)) continue;
    const Tri& v = mesh_.tris[t];
    m.area += area_[t];
    m.curvature += curvature_[t];
    m.middle = m.middle + (area_[t] / 3) * (mesh_.points[v[0]] + mesh_.points[v[1]] + mesh_.points[v[2]]);
  }
  return m;
}

template <class Inside>
DistortionModel::Region DistortionModel::take_region(const std::vector<int>& border, Inside inside) const {
  const int n = aggregates_.n;
  Region r;
  r.divided.assign(n, 0);
  for (int h : border)
    if (int o = opposite_[h]; o >= 0 && aggregates_.of[h / 3] == aggregates_.of[o / 3])
      r.divided[aggregates_.of[h / 3]] = 1;
  r.area.assign(n, 0);
  r.charge.assign(n, 0);
  r.middle.resize(n);
  r.unknown.assign(n, -1);
  for (int g = 0; g < n; ++g) {
    if (!r.divided[g] && !inside(member_[start_[g]])) continue;
    const Moments m = r.divided[g] ? gather(g, inside) : whole_[g];
    if (!(m.area > 0)) continue;
    r.unknown[g] = (int)r.members.size();
    r.members.push_back(g);
    r.area[g] = m.area;
    r.charge[g] = -m.curvature;
    r.middle[g] = (1 / m.area) * m.middle;
  }
  return r;
}

/// The turns of a loop at its edges' origins: the angles missing to a half turn. They hold the curvature of
/// the border's vertices, which leaves the aggregates.
template <class Inside>
std::vector<double> DistortionModel::turns_of(const std::vector<int>& loop, Inside inside,
                                              Region& region) const {
  std::vector<double> turn;
  for (int h : loop) {
    const int v = origin(mesh_.tris, h);
    double fan = angle_[h];
    for (int g = prev(h); opposite_[g] >= 0 && inside(opposite_[g] / 3); g = prev(opposite_[g]))
      fan += angle_[opposite_[g]];
    if (!on_border_[v] && angle_sum_[v] > 0)
      region.charge[aggregates_.of[h / 3]] += (2 * pi / angle_sum_[v] - 1) * fan;
    turn.push_back(pi - fan);
  }
  return turn;
}

template <class Inside>
void DistortionModel::solve_scale(const std::vector<Contact>& with_rim, Inside inside, Region& r) const {
  r.rim_weight.assign(aggregates_.n, 0);
  Laplacian matrix((int)r.members.size());
  for (int g : r.members)
    if (with_rim[g].length > 0) {
      const Vec3 way = with_rim[g].place() - r.middle[g];
      r.rim_weight[g] = with_rim[g].width(way) / std::max(norm(way), 0.1 * std::sqrt(r.area[g]));
      matrix.add_edge(r.unknown[g], -1, r.rim_weight[g]);
    }
  for (const Contact& both : contact_) {
    const int c = aggregates_.of[aggregates_.crossing[both.first] / 3];
    const int d = aggregates_.of[opposite_[aggregates_.crossing[both.first]] / 3];
    if (r.unknown[c] < 0 || r.unknown[d] < 0) continue;
    Contact contact = both;
    if (r.divided[c] || r.divided[d]) {
      contact = {};
      for (int i = both.first; i < both.last; ++i)
        if (const int h = aggregates_.crossing[i]; inside(h / 3) && inside(opposite_[h] / 3))
          contact.add(mesh_, h);
    }
    if (!(contact.length > 0)) continue;
    const Vec3 m = contact.place();
    const double way = norm(m - r.middle[c]) + norm(m - r.middle[d]);
    const double w = contact.width(r.middle[d] - r.middle[c]) /
                     std::max(way, 0.1 * std::sqrt(std::min(r.area[c], r.area[d])));
    matrix.add_edge(r.unknown[c], r.unknown[d], w);
  }
  for (int g : r.members) r.scale.push_back(r.charge[g]);
  matrix.factorize().solve(r.scale);
}

DistortionEstimate DistortionModel::of(const std::vector<int>& label, int a, int b,
                                       const std::vector<int>& border) const {
  auto inside = [&](int t) { return label[t] == a || label[t] == b; };
  const std::vector<int>& of = aggregates_.of;
  Region region = take_region(border, inside);
  const std::vector<Loop> loops = loops_of({mesh_, opposite_}, border, inside);
  std::size_t longest = 0;
  for (std::size_t l = 0; l < loops.size(); ++l)
    if (loops[l].length > loops[longest].length) longest = l;
  std::vector<double> turn;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const std::vector<double> here = turns_of(loops[l].half_edges, inside, region);
    if (l == longest) {
      turn = here;
      continue;
    }
    // a hole turns once around the other way, in all
    for (std::size_t i = 0; i < here.size(); ++i) {
      const int h = loops[l].half_edges[i];
      region.charge[of[h / 3]] -= here[i] + 2 * pi * edge_length(mesh_, h) / loops[l].length;
    }
  }
  const Loop& rim = loops[longest];
  std::vector<Contact> with_rim(aggregates_.n);
  for (int h : rim.half_edges) with_rim[of[h / 3]].add(mesh_, h);
  solve_scale(with_rim, inside, region);

  DistortionEstimate estimate;
  estimate.area_distortion = std::exp(spread_of(region.scale, region.members, region.area));
  const std::size_t n = rim.half_edges.size();
  for (std::size_t i = 0; i < n; ++i) {
    const int h = rim.half_edges[i], g = of[h / 3];
    const double flux =
        -region.rim_weight[g] * region.scale[region.unknown[g]] * edge_length(mesh_, h) / with_rim[g].length;
    turn[i] += flux / 2;
    turn[(i + 1) % n] += flux / 2;
  }
  estimate.crossings = outline_crossings(mesh_, rim, turn);
  return estimate;
}

}  // namespace meshpipe
