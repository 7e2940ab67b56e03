// SPDX-License-Identifier: BSD-3-Clause
#include "lib/mesh2d/adapt.h"

#include <algorithm>

namespace meshpipe {
namespace {

// Lengths are over the size, so that the wanted edge has length one. Halves of the longest edge allowed have
// the shortest length allowed.
constexpr double longest = 1.44, shortest = 0.72;
constexpr int most_rounds = 40, polishing_rounds = 4;

class Adapter {
 public:
  Adapter(SiteMesh& mesh, const SizeMetric& field) : m_(mesh), cdt_(mesh.cdt), field_(field) {}

  void run() {
    // splitting alone halves edges until none is long; then all operations in turn
    for (int round = 0; round < most_rounds && (split_long() > 0 || insert_missed() > 0); ++round) {
    }
    for (int round = 0; round < polishing_rounds; ++round) {
      flip_to_delaunay(m_);
      collapse_short();
      smooth_in_plane(m_, field_, 1);
      split_long();
    }
    collapse_short();
    compact();
  }

 private:
  struct Edge {
    double length;
    int half_edge, version;
  };

  double length(int v, int w) const {
    const Site &a = m_.site[v], &b = m_.site[w];
    return 2 * norm(b.space - a.space) / (a.size + b.size);
  }
  double length(int h) const { return length(cdt_.origin(h), cdt_.target(h)); }

  // Fills edges_ with the free edges that `wanted(length)`, in the order of `before`.
  template <class Wanted, class Before>
  void gather(Wanted wanted, Before before) {
    edges_.clear();
    for (int h = 0; h < (int)cdt_.opposite.size(); ++h) {
      if (cdt_.opposite[h] < h || cdt_.fixed[h]) continue;
      double l = length(h);
      if (wanted(h, l)) edges_.push_back({l, h, cdt_.version[h / 3]});
    }
    std::sort(edges_.begin(), edges_.end(), [&](const Edge& x, const Edge& y) {
      return x.length != y.length ? before(x.length, y.length) : x.half_edge < y.half_edge;
    });
  }
  bool is_there(const Edge& e) const {
    return e.half_edge < (int)cdt_.opposite.size() && cdt_.version[e.half_edge / 3] == e.version;
  }

  // An edge that spans a bend of the surface is longer than its chord: its length in the metric at its ends
  // is a better estimate until it is split.
  double bent_length(int h) const {
    const int v = cdt_.origin(h), w = cdt_.target(h);
    return norm(factor_of(0.5 * (m_.site[v].metric + m_.site[w].metric)).to(cdt_.points[w] - cdt_.points[v]));
  }

  int split_long() {
    gather([&](int h, double l) { return l > longest || bent_length(h) > longest; }, std::greater<>());
    int done = 0;
    for (const Edge& e : edges_)
      if (is_there(e)) done += split_long_edge(m_, field_, e.half_edge, longest);
    return done;
  }

  int insert_missed() {
    int done = 0;
    for (const Missed& m : missed_vertices(m_, field_)) {
      const int t = cdt_.walk(m.p, m.triangle);
      done += t >= 0 && insert_site(m_, m.p, field_.at(m.p, m.face), t, least_spacing);
    }
    return done;
  }

  // Moving v onto the target of h makes no edge long.
  bool stays_short(int h) const {
    bool good = true;
    cdt_.around(cdt_.origin(h),
                [&](int e) { good = good && length(cdt_.target(h), cdt_.target(e)) < longest; });
    return good;
  }

  void collapse_short() {
    gather([&](int, double l) { return l < shortest; }, std::less<>());
    for (const Edge& e : edges_) {
      if (!is_there(e)) continue;
      for (int h : {e.half_edge, cdt_.opposite[e.half_edge]}) {
        if (cdt_.origin(h) < m_.line_points || !cdt_.can_collapse(h) || !stays_short(h)) continue;
        cdt_.collapse(h);
        break;
      }
    }
  }

  void compact() {
    std::vector<int> number(cdt_.points.size(), -1);
    int n = 0;
    for (int v = 0; v < (int)number.size(); ++v) {
      if (cdt_.at[v] < 0) continue;
      number[v] = n;
      cdt_.points[n] = cdt_.points[v];
      cdt_.at[n] = cdt_.at[v];
      m_.site[n] = m_.site[v];
      ++n;
    }
    cdt_.points.resize(n);
    cdt_.at.resize(n);
    m_.site.resize(n);
    for (Tri& t : cdt_.tris)
      for (int& v : t) v = number[v];
  }

  SiteMesh& m_;
  Cdt& cdt_;
  const SizeMetric& field_;
  std::vector<Edge> edges_;
};

}  // namespace

void adapt_edges(SiteMesh& mesh, const SizeMetric& field) { Adapter(mesh, field).run(); }

}  // namespace meshpipe
