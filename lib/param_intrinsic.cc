// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param_intrinsic.h"

#include <algorithm>
#include <deque>

#include "lib/topology.h"

namespace meshpipe {
namespace {

/// A triangle in its plane by its edge lengths: from 0 along x over the first edge to `b`, and its third
/// corner.
struct Layout {
  double b;
  Vec2 c;
};

/// l[i]: length of the edge from corner i to i+1.
Layout lay_out(double l0, double l1, double l2) {
  double x = (l0 * l0 + l2 * l2 - l1 * l1) / (2 * l0);
  // Heron's formula in Kahan's stable order
  std::array<double, 3> s{l0, l1, l2};
  std::sort(s.begin(), s.end());
  double area16 =
      (s[2] + (s[1] + s[0])) * (s[0] - (s[2] - s[1])) * (s[0] + (s[2] - s[1])) * (s[2] + (s[1] - s[0]));
  return {l0, {x, std::sqrt(std::max(area16, 0.0)) / (2 * l0)}};
}

class Flipper {
 public:
  explicit Flipper(Filled& filled) : filled_(filled) {
    opposite_ = opposite_halfedges(filled.tris, filled.n_vertices);
    for (const auto& p : filled.shape) {
      std::array<double, 3> l{norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])};
      double sum = l[0] + l[1] + l[2], more = 0;
      if (!(sum > 0)) l.fill(1);
      for (double side : l) more = std::max(more, 1e-7 * sum - (sum - 2 * side));
      for (double side : l) length_.push_back(side + more);
    }
  }

  void run() {
    std::deque<int> queue;
    std::vector<char> waiting(opposite_.size(), 0);
    for (int h = 0; h < (int)opposite_.size(); ++h)
      if (opposite_[h] > h && !delaunay(h)) {
        queue.push_back(h);
        waiting[h] = 1;
      }
    // the bound only guards against going round in circles by rounding
    for (std::size_t left = 200 * opposite_.size(); !queue.empty() && left > 0; --left) {
      int h = queue.front();
      queue.pop_front();
      waiting[h] = 0;
      // flips move edges: what is here by now may be another one, even of the border
      if (opposite_[h] < 0 || delaunay(h) || !flip(h)) continue;
      for (int e : {next(h), prev(h), next(opposite_[h]), prev(opposite_[h])}) {
        if (opposite_[e] < 0) continue;
        int g = std::min(e, opposite_[e]);
        if (!waiting[g] && !delaunay(g)) {
          queue.push_back(g);
          waiting[g] = 1;
        }
      }
    }
  }

  void write_shapes() {
    for (std::size_t t = 0; t < filled_.tris.size(); ++t) {
      Layout l = lay_out(length_[3 * t], length_[3 * t + 1], length_[3 * t + 2]);
      filled_.shape[t] = {Vec3{0, 0, 0}, {l.b, 0, 0}, {l.c.x, l.c.y, 0}};
    }
  }

 private:
  Layout layout(int h) const { return lay_out(length_[h], length_[next(h)], length_[prev(h)]); }

  /// The cotangents opposite to the edge do not add up to less than 0.
  bool delaunay(int h) const {
    auto cotangent = [](const Layout& l) {
      // of the angle at c between the ways to the ends of the edge
      Vec2 a{-l.c.x, -l.c.y}, b{l.b - l.c.x, -l.c.y};
      return dot(a, b) / std::max(cross(a, b), 1e-300);
    };
    return cotangent(layout(h)) + cotangent(layout(opposite_[h])) >= -1e-9;
  }

  /// Turns the edge h from i -> j with the apexes k (left) and m (right) into the edge m -> k.
  bool flip(int h) {
    int g = opposite_[h], hn = next(h), hp = prev(h), gn = next(g), gp = prev(g);
    if (h / 3 == g / 3) return false;
    // of a fan's edge and the border's the lengths differ: what is on the right is scaled to fit
    double scale = length_[h] / length_[g];
    for (int e : {g, gn, gp}) length_[e] *= scale;
    Layout left = layout(h), right = layout(g);
    // in one plane, i at 0 and j at (b, 0); seen from the right triangle the edge runs the other way
    Vec2 k = left.c, m{left.b - right.c.x, -right.c.y}, j{left.b, 0};
    if (!(cross(m, k) > 0 && cross(k - j, m - j) > 0))
      return false;  // the two do not form a convex quadrilateral
    double diagonal = norm(k - m);
    auto& tris = filled_.tris;
    int vi = origin(tris, h), vj = origin(tris, g), vk = origin(tris, hp), vm = origin(tris, gp);
    // h becomes m -> k with apex i: (m, k, i); its next edge is k -> i (old hp), then i -> m (old gn)
    // g becomes k -> m with apex j: (k, m, j); its next edge is m -> j (old gp), then j -> k (old hn)
    std::array<int, 4> old{hp, gn, gp, hn}, outer;
    std::array<double, 4> l;
    for (int e = 0; e < 4; ++e) {
      outer[e] = opposite_[old[e]];
      l[e] = length_[old[e]];
    }
    std::array<int, 4> place{next(h), prev(h), next(g), prev(g)};
    // an outer edge may be another of the four
    for (int& o : outer)
      for (int e = 0; e < 4; ++e)
        if (o == old[e]) {
          o = place[e];
          break;
        }
    set_corner(h, vm), set_corner(next(h), vk), set_corner(prev(h), vi);
    set_corner(g, vk), set_corner(next(g), vm), set_corner(prev(g), vj);
    for (int e = 0; e < 4; ++e) {
      length_[place[e]] = l[e];
      opposite_[place[e]] = outer[e];
      if (outer[e] >= 0) opposite_[outer[e]] = place[e];
    }
    length_[h] = length_[g] = diagonal;
    return true;
  }

  void set_corner(int h, int v) { filled_.tris[h / 3][h % 3] = v; }

  Filled& filled_;
  std::vector<int> opposite_;
  std::vector<double> length_;  ///< of half-edges: a triangle's shape, at a scale of its own
};

}  // namespace

Filled intrinsic_delaunay(Filled filled) {
  Flipper flipper(filled);
  flipper.run();
  flipper.write_shapes();
  return filled;
}

}  // namespace meshpipe
