// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <queue>
#include <tuple>

#include "lib/clean/repair.h"
#include "lib/core/least_area.h"
#include "lib/core/lists.h"
#include "lib/core/predicates.h"
#include "lib/core/topology.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

/// Loops of more corners than this have ears cut off until they have no more: about a second of the
/// optimization, which is cubic.
constexpr int most_corners = 1000;

/// Cuts ears off a long loop, those of the shortest chords first, so that what is left has a corner for every
/// few of its own, all the way around. Convexity and overlaps are judged along the loop's mean normal.
class EarCutter {
 public:
  /// `joined(i, j)`: has the mesh an edge between these corners?
  template <class Joined>
  EarCutter(const std::vector<Vec3>& corners, Joined joined, std::vector<Tri>& tris) : p_(corners) {
    project();
    const int n = (int)p_.size();
    int left = n;
    for (bool any = true; any && left > most_corners;) {
      any = false;
      for (int i = 0; i < n; ++i)
        if (next_[i] >= 0) push(i);
      while (!queue_.empty() && left > most_corners) {
        const Ear e = queue_.top();
        queue_.pop();
        if (next_[e.at] < 0 || previous_[e.at] != e.from || next_[e.at] != e.to) continue;
        if (!is_ear(e) || joined(e.from, e.to)) continue;
        tris.push_back({e.from, e.at, e.to});
        next_[e.from] = e.to;
        previous_[e.to] = e.from;
        next_[e.at] = -1;
        --left;
        any = true;
        push(e.from);
        push(e.to);
      }
    }
  }

  /// Returns the corners that are left, in their order.
  std::vector<int> left() const {
    std::vector<int> corners;
    for (int i = 0; i < (int)p_.size(); ++i)
      if (next_[i] >= 0) corners.push_back(i);
    return corners;
  }

 private:
  struct Ear {
    double length;  ///< of the chord
    int from, at, to;
    bool operator<(const Ear& e) const { return std::pair(e.length, e.at) < std::pair(length, at); }
  };

  void project() {
    const int n = (int)p_.size();
    Vec3 normal;
    for (int i = 0; i < n; ++i) normal = normal + area_vector(p_[0], p_[i], p_[(i + 1) % n]);
    const Vec3 axis = std::abs(normal.x) > 0.5 * norm(normal) ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 right = normalized(cross(axis, normal)), up = cross(normalized(normal), right);
    for (int i = 0; i < n; ++i) {
      flat_.push_back({dot(p_[i] - p_[0], right), dot(p_[i] - p_[0], up)});
      previous_.push_back((i + n - 1) % n);
      next_.push_back((i + 1) % n);
    }
    by_x_ = identity(n);
    std::sort(by_x_.begin(), by_x_.end(),
              [&](int a, int b) { return std::pair(flat_[a].x, a) < std::pair(flat_[b].x, b); });
  }

  void push(int i) { queue_.push({norm(p_[next_[i]] - p_[previous_[i]]), previous_[i], i, next_[i]}); }

  bool is_ear(const Ear& e) const {
    const Vec2 a = flat_[e.from], b = flat_[e.at], c = flat_[e.to];
    if (orient2d(a, b, c) <= 0) return false;
    const double end = std::max({a.x, b.x, c.x});
    auto at = std::lower_bound(by_x_.begin(), by_x_.end(), std::min({a.x, b.x, c.x}),
                               [&](int i, double x) { return flat_[i].x < x; });
    for (; at != by_x_.end() && flat_[*at].x <= end; ++at) {
      const int i = *at;
      if (next_[i] < 0 || i == e.from || i == e.at || i == e.to) continue;
      const Vec2 p = flat_[i];
      if (orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0) return false;
    }
    return true;
  }

  const std::vector<Vec3>& p_;
  std::vector<Vec2> flat_;
  std::vector<int> previous_, next_, by_x_;
  std::priority_queue<Ear> queue_;
};

/// Fills the loops of a surface one by one.
class HoleFiller {
 public:
  HoleFiller(Repair& r, const std::vector<Vec3>& points)
      : r_(r),
        points_(points),
        spoke_(r.vertex.size(), -1),
        copy_(spoke_),
        last_(r.split.size(), -1),
        place_(last_) {
    for (int h = 0; h < (int)r.opposite.size(); ++h) {
      const int v = origin(r.tris, h);
      if (spoke_[v] >= 0) continue;
      spoke_[v] = h;
      copy_[v] = last_[base(r, v)];
      last_[base(r, v)] = v;
    }
  }

  /// Returns the number of triangles added: 0 if the hole stays.
  int fill(const std::vector<int>& loop) {
    const int n = (int)loop.size();
    // a hole is seen from its own side: its corners run against the half-edges of the border
    vertices_.clear();
    corners_.clear();
    bool sound = true;
    for (int i = n - 1; i >= 0; --i) {
      const int v = target(r_.tris, loop[i]), p = base(r_, v);
      sound = sound && place_[p] < 0 && !r_.split[p];
      vertices_.push_back(v);
      corners_.push_back(points_[r_.vertex[v]]);
      place_[p] = n - 1 - i;
    }
    if (n == 3)
      for_each_joined(0, [&](int j, int k) { sound = sound && (j < 0 || k < 0); });  // the triangle is there
    const std::vector<Tri> tris = sound ? triangles() : std::vector<Tri>{};
    for (int v : vertices_) place_[base(r_, v)] = -1;
    if (!tris.empty()) add(tris, loop);
    return (int)tris.size();
  }

 private:
  /// Calls visit(j, k) with the corners, or -1, that the further vertices of each triangle at corner i are.
  /// Copies of a vertex count as one: filling may not make two edges or triangles at the same place, even on
  /// different sheets.
  template <class Visit>
  void for_each_joined(int i, Visit visit) const {
    for (int v = last_[base(r_, vertices_[i])]; v >= 0; v = copy_[v])
      for_each_spoke(r_.opposite, spoke_[v], [&](int g) {
        visit(place_[base(r_, target(r_.tris, g))], place_[base(r_, origin(r_.tris, prev(g)))]);
      });
  }

  /// Triangles of corners; none if the loop has no triangulation.
  std::vector<Tri> triangles() const {
    const int n = (int)corners_.size();
    std::vector<Tri> tris;
    std::vector<int> kept = identity(n);
    if (n > most_corners) {
      auto joined = [&](int i, int j) {
        bool is = false;
        for_each_joined(i, [&](int a, int b) { is = is || a == j || b == j; });
        return is;
      };
      kept = EarCutter(corners_, joined, tris).left();
    }
    const int m = (int)kept.size();
    if (m > most_corners) return {};
    std::vector<int> number(n, -1);
    std::vector<Vec3> corners;
    for (int i = 0; i < m; ++i) {
      number[kept[i]] = i;
      corners.push_back(corners_[kept[i]]);
    }
    std::vector<char> joined(m * m, 0);
    for (int i = 0; i < m; ++i)
      for_each_joined(kept[i], [&](int a, int b) {
        for (int j : {a, b})
          if (j >= 0 && number[j] >= 0) joined[i * m + number[j]] = joined[number[j] * m + i] = 1;
      });
    const std::vector<Tri> inner = least_area_triangles(corners, joined);
    if (inner.empty()) return {};
    for (const Tri& t : inner) tris.push_back({kept[t[0]], kept[t[1]], kept[t[2]]});
    return tris;
  }

  void add(const std::vector<Tri>& tris, const std::vector<int>& loop) {
    const int n = (int)loop.size();
    const int face = ~source(r_, *std::min_element(loop.begin(), loop.end()) / 3);
    struct Side {
      int a, b, h;  ///< corners, a < b, and the half-edge of the mesh between them
    };
    std::vector<Side> sides;
    auto side = [&](int a, int b, int h) { sides.push_back({std::min(a, b), std::max(a, b), h}); };
    for (int i = 0; i < n; ++i) side(i, (i + 1) % n, loop[n - 1 - i]);
    for (const Tri& t : tris) {
      for (int i = 0; i < 3; ++i) side(t[i], t[(i + 1) % 3], 3 * (int)r_.tris.size() + i);
      r_.tris.push_back({vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]});
      r_.face.push_back(face);
      r_.flipped.push_back(0);
    }
    r_.opposite.resize(3 * r_.tris.size(), -1);
    std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
      return std::tuple(x.a, x.b, x.h) < std::tuple(y.a, y.b, y.h);
    });
    for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
      r_.opposite[sides[i].h] = sides[i + 1].h;
      r_.opposite[sides[i + 1].h] = sides[i].h;
    }
  }

  Repair& r_;
  const std::vector<Vec3>& points_;
  std::vector<int> spoke_, copy_, last_;  ///< per vertex; copies of a vertex as a list that starts at `last_`
  std::vector<int> place_;                ///< per base vertex: which corner of the loop at hand, or -1
  std::vector<int> vertices_;             ///< per corner of the loop at hand
  std::vector<Vec3> corners_;
};

}  // namespace

HoleCounts fill_holes(Repair& r, const std::vector<Vec3>& points, int most) {
  HoleCounts counts;
  HoleFiller filler(r, points);
  for (const std::vector<int>& loop : boundary_loops(r.opposite)) {
    if ((int)loop.size() > most) continue;
    const int added = filler.fill(loop);
    ++(added ? counts.filled : counts.left);
    counts.triangles += added;
  }
  return counts;
}

std::vector<int> caps_of(const Repair& r) {
  const int n = (int)r.tris.size();
  UnionFind pieces(n);
  for (int h = 0; h < (int)r.opposite.size(); ++h)
    if (const int g = r.opposite[h]; g > h && r.face[g / 3] < 0 && r.face[h / 3] < 0)
      pieces.join(g / 3, h / 3);
  std::vector<int> cap(n, -1), number(n, -1);
  int count = 0;
  for (int t = 0; t < n; ++t)
    if (r.face[t] < 0) {
      int& k = number[pieces.find(t)];
      if (k < 0) k = count++;
      cap[t] = k;
    }
  return cap;
}

}  // namespace meshpipe
