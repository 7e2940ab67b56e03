// SPDX-License-Identifier: BSD-3-Clause
#include "lib/resolve/arrange.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "lib/core/lists.h"
#include "lib/resolve/plane.h"

namespace meshpipe {
namespace {

/// A segment in the plane of a triangle, or a point (a == b).
struct Cut {
  int triangle, a, b;
  auto operator<=>(const Cut&) const = default;
};

class Cuts {
 public:
  Cuts(const std::vector<Tri>& tris, ExactPoints& points)
      : tris_(tris), points_(points), coplanar(tris.size(), 0) {}
  void add(int s, int t);

 private:
  void edge_and_triangle(int p, int q, int at_p, int at_q, const Tri& t);
  void edge_in_plane(int p, int q, const Tri& t);
  bool inside(int p, const Tri& t, Projection view) const;
  bool strictly_between(int p, int a, int b) const;
  void put(int s, int t);

  const std::vector<Tri>& tris_;
  ExactPoints& points_;
  std::vector<int> found_;

 public:
  std::vector<Cut> cuts;
  std::vector<char> coplanar;  ///< flags triangles that share an area with another
};

bool Cuts::inside(int p, const Tri& t, Projection view) const {
  for (int i = 0; i < 3; ++i)
    if (points_.turn(t[i], t[(i + 1) % 3], p, view) < 0) return false;
  return true;
}

bool Cuts::strictly_between(int p, int a, int b) const {
  for (int k = 0; k < 3; ++k)
    if (const int c = points_.compare(a, b, k); c != 0)
      return points_.compare(a, p, k) == c && points_.compare(p, b, k) == c;
  return false;
}

/// The ends of what edge pq has in common with a triangle of its plane.
void Cuts::edge_in_plane(int p, int q, const Tri& t) {
  const Projection view = points_.view(t);
  for (int v : {p, q})
    if (inside(v, t, view)) found_.push_back(v);
  for (int i = 0; i < 3; ++i) {
    const int a = t[i], b = t[(i + 1) % 3];
    const int at_a = points_.turn(p, q, a, view), at_b = points_.turn(p, q, b, view);
    if (at_a == 0 && strictly_between(a, p, q)) found_.push_back(a);
    if (at_a * at_b < 0 && points_.turn(a, b, p, view) * points_.turn(a, b, q, view) < 0)
      found_.push_back(points_.line_and_line(p, q, a, b, view));
  }
}

/// The same in space; `at_p`, `at_q`: the sides of the triangle's plane that the ends are on.
void Cuts::edge_and_triangle(int p, int q, int at_p, int at_q, const Tri& t) {
  if (at_p * at_q > 0) return;
  if (at_p == 0 && at_q == 0) return edge_in_plane(p, q, t);
  if (at_p == 0 || at_q == 0) {
    const int v = at_p == 0 ? p : q;
    if (inside(v, t, points_.view(t))) found_.push_back(v);
    return;
  }
  int around[3];
  for (int i = 0; i < 3; ++i) around[i] = points_.side({p, q, t[i]}, t[(i + 1) % 3]);
  for (int i = 0; i < 3; ++i) {
    if (around[i] * around[(i + 1) % 3] < 0) return;
    if (around[i] == 0 && around[(i + 1) % 3] == 0) return found_.push_back(t[(i + 1) % 3]);
  }
  found_.push_back(points_.line_and_plane(p, q, t));
}

void Cuts::put(int s, int t) {
  sort_unique(found_);
  if (found_.empty()) return;
  for (int u : {s, t}) cuts.push_back({u, found_.front(), found_.back()});
  found_.clear();
}

void Cuts::add(int s, int t) {
  const Tri &a = tris_[s], &b = tris_[t];
  int side_a[3], side_b[3];
  for (int i = 0; i < 3; ++i) side_a[i] = points_.side(b, a[i]), side_b[i] = points_.side(a, b[i]);
  const bool flat = !side_a[0] && !side_a[1] && !side_a[2];
  for (const auto& [p, at, q] : {std::tuple{&a, side_a, &b}, {&b, side_b, &a}})
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      edge_and_triangle((*p)[i], (*p)[j], at[i], at[j], *q);
      if (flat) put(s, t);  // each edge on its own
    }
  put(s, t);
  if (flat) coplanar[s] = coplanar[t] = 1;
}

/// Triangulations of regions that triangles in one plane share: whichever comes first is everyone's.
class Regions {
 public:
  explicit Regions(const ExactPoints& points) : points_(points) {}
  /// Appends the triangles of an arrangement, or what was found before for its regions.
  void append(const TriangleArrangement& plane, const Tri& corners, std::vector<Tri>& out);

 private:
  struct Region {
    std::vector<Tri> tris;
    Tri corners;
  };
  const ExactPoints& points_;
  std::map<std::vector<std::array<int, 2>>, Region> known_;  ///< by fixed edges
};

void Regions::append(const TriangleArrangement& plane, const Tri& corners, std::vector<Tri>& out) {
  const auto& tris = plane.mesh().tris;
  std::vector<char> done(tris.size(), 0);
  std::vector<int> todo;
  for (int seed = 0; seed < (int)tris.size(); ++seed) {
    if (done[seed]) continue;
    std::vector<std::array<int, 2>> rim;
    Region region{{}, corners};
    done[seed] = 1;
    todo.assign(1, seed);
    while (!todo.empty()) {
      const int t = take_last(todo);
      region.tris.push_back(tris[t]);
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int a = origin(tris, h), b = target(tris, h);
        if (plane.mesh().fixed(h))
          rim.push_back({std::min(a, b), std::max(a, b)});
        else if (const int u = plane.mesh().opposite[h] / 3; !done[u]) {
          done[u] = 1;
          todo.push_back(u);
        }
      }
    }
    std::sort(rim.begin(), rim.end());
    const Region& first = known_.try_emplace(std::move(rim), std::move(region)).first->second;
    const auto [a, b, c] = first.corners;
    const bool reversed = points_.turn(a, b, c, points_.view(corners)) < 0;
    for (Tri t : first.tris) {
      if (reversed) std::swap(t[1], t[2]);
      out.push_back(t);
    }
  }
}

}  // namespace

void unite_coincident(Pieces& pieces) {
  std::vector<std::pair<Tri, int>> order;
  order.reserve(pieces.tris.size());
  for (int t = 0; t < (int)pieces.tris.size(); ++t) {
    Tri s = pieces.tris[t];
    std::sort(s.begin(), s.end());
    order.push_back({s, t});
  }
  std::sort(order.begin(), order.end());
  std::vector<int> same(order.size());
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (order[i].first != order[first].first) first = i;
    const int t = order[first].second, u = order[i].second;
    same[u] = t;
    if (u == t) continue;
    const Tri &a = pieces.tris[t], &b = pieces.tris[u];
    const int k = (int)(std::find(b.begin(), b.end(), a[0]) - b.begin());
    pieces.weight[t] += a[1] == b[(k + 1) % 3] ? pieces.weight[u] : -pieces.weight[u];
  }
  int n = 0;
  for (int t = 0; t < (int)same.size(); ++t) {
    if (same[t] != t) {
      same[t] = same[same[t]];
      continue;
    }
    same[t] = n;
    pieces.tris[n] = pieces.tris[t];
    pieces.origin[n] = pieces.origin[t];
    pieces.weight[n++] = pieces.weight[t];
  }
  pieces.tris.resize(n);
  pieces.origin.resize(n);
  pieces.weight.resize(n);
  for (int& t : pieces.piece_of) t = same[t];
}

Pieces arrange(const std::vector<Tri>& tris, const std::vector<int>& weight,
               const std::vector<std::pair<int, int>>& pairs, ExactPoints& points) {
  Cuts found(tris, points);
  for (const auto& [s, t] : pairs) found.add(s, t);
  std::vector<Cut>& cuts = found.cuts;
  sort_unique(cuts);
  Pieces pieces;
  TriangleArrangement plane(points);
  Regions regions(points);
  auto next = cuts.begin();
  for (int t = 0; t < (int)tris.size(); ++t) {
    auto first = next;
    pieces.piece_of.push_back((int)pieces.tris.size());
    while (next != cuts.end() && next->triangle == t) ++next;
    if (first == next) {
      pieces.tris.push_back(tris[t]);
    } else {
      plane.start(tris[t]);
      for (auto c = first; c < next; ++c)
        for (int p : {c->a, c->b}) plane.insert(p);
      for (auto c = first; c < next; ++c)
        if (c->a != c->b) plane.insert(c->a, c->b);
      plane.improve();
      if (found.coplanar[t])
        regions.append(plane, tris[t], pieces.tris);
      else
        pieces.tris.insert(pieces.tris.end(), plane.mesh().tris.begin(), plane.mesh().tris.end());
    }
    pieces.origin.resize(pieces.tris.size(), t);
    pieces.weight.resize(pieces.tris.size(), weight[t]);
  }
  unite_coincident(pieces);
  return pieces;
}

}  // namespace meshpipe
