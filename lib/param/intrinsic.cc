// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/intrinsic.h"

#include <algorithm>
#include <deque>

#include "lib/core/topology.h"

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
    length_.reserve(opposite_.size());
    changed_.reserve(filled.tris.size());
    for (const auto& p : filled.shape) {
      std::array<double, 3> l{norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])};
      double sum = l[0] + l[1] + l[2], more = 0;
      if (!(sum > 0)) l.fill(1);
      for (double side : l) more = std::max(more, 1e-7 * sum - (sum - 2 * side));
      for (double side : l) length_.push_back(side + more);
      changed_.push_back(more > 0 || !(sum > 0));
    }
  }

  void run() {
    std::deque<int> queue;
    std::vector<char> waiting(opposite_.size(), 0);
    std::vector<double> cotangent;  // most edges stay: their triangles are looked at once
    cotangent.reserve(opposite_.size());
    for (int h = 0; h < (int)opposite_.size(); h += 3)
      for (int i = 0; i < 3; ++i) cotangent.push_back(cotangent_opposite(layout(h), i));
    for (int h = 0; h < (int)opposite_.size(); ++h)
      if (opposite_[h] > h && !(cotangent[h] + cotangent[opposite_[h]] >= least)) {
        queue.push_back(h);
        waiting[h] = 1;
      }
    // the bound only guards against endless flips by rounding
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
      if (!changed_[t]) continue;
      Layout l = lay_out(length_[3 * t], length_[3 * t + 1], length_[3 * t + 2]);
      filled_.shape[t] = {Vec3{0, 0, 0}, {l.b, 0, 0}, {l.c.x, l.c.y, 0}};
    }
  }

 private:
  Layout layout(int h) const { return lay_out(length_[h], length_[next(h)], length_[prev(h)]); }

  static constexpr double least = -1e-9;  ///< of the cotangents opposite to an edge, added up

  /// Of the corner opposite to edge i: 0 is the one that was laid out along x.
  static double cotangent_opposite(const Layout& l, int i) {
    const Vec2 corner[3] = {{0, 0}, {l.b, 0}, l.c}, at = corner[(i + 2) % 3];
    const Vec2 a = corner[i] - at, b = corner[(i + 1) % 3] - at;
    return dot(a, b) / std::max(cross(a, b), 1e-300);
  }
  bool delaunay(int h) const {
    return cotangent_opposite(layout(h), 0) + cotangent_opposite(layout(opposite_[h]), 0) >= least;
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
    changed_[h / 3] = changed_[g / 3] = 1;
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
  std::vector<char> changed_;   ///< triangles whose shape is not the one given
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
