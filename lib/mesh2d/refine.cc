// SPDX-License-Identifier: BSD-3-Clause
#include "lib/mesh2d/refine.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace meshpipe {
namespace {

// Lengths below are over the size, so that the wanted edge has length one.
const double ideal_radius = 1 / std::sqrt(3.0);  // of the equilateral triangle's circumcircle
struct Rule {
  bool fronts;             // points go to the fronts first; otherwise always to circumcenters
  double accepted_radius;  // a triangle below this needs no point
  Spacing spacing;
};
// Measured together on flat, curved and sheared charts: the count is within 2 % of what the size asks for,
// and shapes are best.
constexpr double much_too_long = 1.8;  // an edge that is split although neither rule found a point
constexpr Rule frontal_rule{true, 0.64, {0.8, 0.45}};
constexpr Rule gap_rule{true, 0.8, {0.8, 0.45}};
constexpr Rule delaunay_rule{false, 0.755, {0.6, 0.3}};

// A triangle in the queue. Fronts first, row by row; then the triangles no front could serve, largest first;
// last those that take no circumcenter either.
enum Rank { at_front, at_center, at_middle };
struct Poor {
  Rank rank;
  double key;  // smaller first
  std::int64_t order;
  int triangle, version;
  bool operator<(const Poor& e) const {
    if (rank != e.rank) return rank > e.rank;
    if (key != e.key) return key > e.key;
    return order > e.order;
  }
};

class Refiner {
 public:
  Refiner(SiteMesh& mesh, const SizeMetric& field, const Rule& rule)
      : m_(mesh), cdt_(mesh.cdt), field_(field), rule_(rule) {}

  void run() {
    row_.assign(cdt_.points.size(), 0);
    radius_.resize(cdt_.tris.size());
    for (std::size_t t = 0; t < radius_.size(); ++t) radius_[t] = radius(t);
    for (std::size_t t = 0; t < radius_.size(); ++t) offer(t);
    do {
      drain_queue();
    } while (insert_missed());
  }

 private:
  void drain_queue() {
    while (!queue_.empty()) {
      Poor e = queue_.top();
      queue_.pop();
      if (cdt_.version[e.triangle] != e.version) continue;
      const bool done = e.rank == at_front    ? insert_from_front(e.triangle)
                        : e.rank == at_center ? insert_at_center(e.triangle)
                                              : insert_at_middle(e.triangle);
      if (!done && e.rank != at_middle)
        queue_.push({Rank(e.rank + 1), -radius_[e.triangle], order_++, e.triangle, e.version});
    }
  }

  bool insert_missed() {
    bool any = false;
    for (const Missed& m : missed_vertices(m_, field_))
      any |= insert(m.p, m.triangle, m.face, 0, least_spacing);
    return any;
  }

  Vec2 point(int v) const { return cdt_.points[v]; }
  const Site& site(int t, int i) const { return m_.site[cdt_.tris[t][i]]; }

  double radius(int t) const {
    const Site &a = site(t, 0), &b = site(t, 1), &c = site(t, 2);
    Vec3 u = b.space - a.space, v = c.space - a.space;
    double area2 = norm(cross(u, v)), h = (a.size + b.size + c.size) / 3;
    return area2 > 0 ? norm(u) * norm(v) * norm(v - u) / (2 * area2 * h) : 1e300;
  }

  bool waits(int t) const { return radius_[t] > rule_.accepted_radius; }
  int row(int h) const { return std::max(row_[cdt_.origin(h)], row_[cdt_.target(h)]); }

  // The front edge of a waiting triangle: next to an accepted one or on a line, in the earliest row; -1 if
  // none.
  int front_edge(int t) const {
    int best = -1;
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (cdt_.fixed[h] || cdt_.opposite[h] < 0 || !waits(cdt_.opposite[h] / 3))
        if (best < 0 || row(h) < row(best)) best = h;
    return best;
  }

  void offer(int t) {
    if (!waits(t)) return;
    int h = rule_.fronts ? front_edge(t) : -1;
    if (h >= 0)
      queue_.push({at_front, (double)row(h), order_++, t, cdt_.version[t]});
    else
      queue_.push({at_center, -radius_[t], order_++, t, cdt_.version[t]});
  }

  // Rebay's point on the edge's bisector: on a circle of the ideal radius through its ends, but no farther
  // than the circumcenter's own triangle would reach. Judged in frame f.
  bool rebay_point(int h, const MetricFactor& f, Vec2& p) const {
    Vec2 a = point(cdt_.origin(h));
    Vec2 b = f.to(point(cdt_.target(h)) - a), c = f.to(point(cdt_.apex(h)) - a);
    double half = 0.5 * norm(b), area2 = cross(b, c);
    if (!(half > 0) || !(area2 > 0)) return false;
    double q = half * dot(c, c - b) / area2;  // from the edge to the circumcenter
    if (!(q > 0)) return false;
    double r = std::min(std::max(ideal_radius, half), (half * half + q * q) / (2 * q));
    double d = r + std::sqrt(std::max(0.0, r * r - half * half));
    Vec2 normal = (0.5 / half) * Vec2{-b.y, b.x};
    p = a + f.back(0.5 * b + d * normal);
    return true;
  }

  bool insert_from_front(int t) {
    int h = front_edge(t);
    if (h < 0) return false;
    const Site &a = m_.site[cdt_.origin(h)], &b = m_.site[cdt_.target(h)];
    Vec2 p;
    if (!rebay_point(h, factor_of(0.5 * (a.metric + b.metric)), p)) return false;
    // once more in the metric between the edge and there
    Site there = field_.at(p, a.place.face);
    if (!rebay_point(h, factor_of((1.0 / 3) * (a.metric + b.metric + there.metric)), p)) return false;
    return insert(p, t, there.place.face, row(h) + 1, rule_.spacing);
  }

  bool insert_at_center(int t) {
    const Tri& v = cdt_.tris[t];
    MetricFactor f = factor_of((1.0 / 3) * (site(t, 0).metric + site(t, 1).metric + site(t, 2).metric));
    Vec2 b = f.to(point(v[1]) - point(v[0])), c = f.to(point(v[2]) - point(v[0]));
    double area2 = cross(b, c);
    if (!(area2 > 0)) return false;
    Vec2 x = (0.5 / area2) * Vec2{c.y * dot(b, b) - b.y * dot(c, c), b.x * dot(c, c) - c.x * dot(b, b)};
    int rows = std::max({row_[v[0]], row_[v[1]], row_[v[2]]});
    return insert(point(v[0]) + f.back(x), t, site(t, 0).place.face, rows + 1, rule_.spacing);
  }

  bool insert(Vec2 p, int t, int hint, int row, const Spacing& spacing) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return false;
    int s = cdt_.walk(p, t);
    if (s < 0) return false;
    Site there = field_.at(p, hint);
    if (!insert_site(m_, p, there, s, spacing)) return false;
    adopt(row);
    return true;
  }

  // The longest edge that may be split.
  bool insert_at_middle(int t) {
    int longest = -1;
    double length = 0;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const double l = norm(m_.site[cdt_.origin(h)].space - m_.site[cdt_.target(h)].space);
      if (!cdt_.fixed[h] && l > length) longest = h, length = l;
    }
    if (longest < 0) return false;
    const int rows = row(longest);
    if (!split_long_edge(m_, field_, longest, much_too_long)) return false;
    adopt(rows + 1);
    return true;
  }

  // The new vertex and its triangles take part.
  void adopt(int row) {
    row_.push_back(row);
    radius_.resize(cdt_.tris.size());
    for (int u : m_.cavity.fan()) radius_[u] = radius(u);
    for (int u : m_.cavity.fan()) {
      offer(u);
      // its outer neighbor has got a front edge if this one is accepted
      int o = cdt_.opposite[3 * u];
      if (!waits(u) && o >= 0) offer(o / 3);
    }
  }

  SiteMesh& m_;
  Cdt& cdt_;
  const SizeMetric& field_;
  const Rule rule_;
  std::vector<int> row_;
  std::vector<double> radius_;
  std::priority_queue<Poor> queue_;
  std::int64_t order_ = 0;
};

}  // namespace

void refine_frontal(SiteMesh& mesh, const SizeMetric& field) { Refiner(mesh, field, frontal_rule).run(); }
void fill_gaps(SiteMesh& mesh, const SizeMetric& field) { Refiner(mesh, field, gap_rule).run(); }
void refine_delaunay(SiteMesh& mesh, const SizeMetric& field) { Refiner(mesh, field, delaunay_rule).run(); }

}  // namespace meshpipe
