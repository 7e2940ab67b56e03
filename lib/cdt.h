// SPDX-License-Identifier: BSD-3-Clause
// A plane triangulation that points are inserted into: constrained Delaunay to begin with, any metric after
// that.
#pragma once
#include <cstdint>
#include <vector>

#include "lib/mesh.h"
#include "lib/predicates.h"

namespace meshpipe {

/// A straight edge that must be in the triangulation; `border` segments bound the region.
struct FixedEdge {
  int a, b;
  bool border;
};

/// Triangles with neighbour links; half-edges as in lib/mesh.h. All triangles are positive by the exact
/// predicate, always.
class Cdt {
 public:
  enum : std::uint8_t { free_edge = 0, inner_segment = 1, border_segment = 2 };

  std::vector<Vec2> points;
  std::vector<Tri> tris;
  std::vector<int> opposite;        ///< -1 on the border
  std::vector<std::uint8_t> fixed;  ///< per half-edge: never flipped nor crossed
  std::vector<int> at;              ///< a triangle of each vertex, -1 for vertices that were collapsed
  std::vector<int> version;         ///< per triangle: counts how often it was replaced

  /// Constrained Delaunay triangulation of the region that the border segments bound (odd parity from
  /// outside). Throws GoalMissed naming a point if two points coincide, segments cross or touch, or the
  /// borders are not closed.
  Cdt(std::vector<Vec2> points, const std::vector<FixedEdge>& segments);

  int origin(int h) const { return tris[h / 3][h % 3]; }
  int target(int h) const { return tris[h / 3][(h + 1) % 3]; }
  int apex(int h) const { return tris[h / 3][(h + 2) % 3]; }

  /// Triangle that holds p, walking from t without crossing a fixed edge (or with `wall` = border_segment,
  /// only a border); -1 if one is in the way.
  int walk(Vec2 p, int t, std::uint8_t wall = inner_segment) const;

  /// Collects the triangles around p (which lies in t) that `conflict(triangle)` wants replaced, as far as p
  /// sees them and without crossing fixed edges. False if p lies on a vertex or on a fixed edge.
  template <class Conflict>
  bool grow_cavity(Vec2 p, int t, Conflict conflict);
  /// Half-edges of the last cavity's rim, each inside the cavity.
  const std::vector<int>& rim() const { return rim_; }
  /// Replaces the last cavity by the fan of a new vertex at p. The fan's triangles are in fan() after it,
  /// with the vertex as their third corner. Returns the vertex.
  int fill_cavity(Vec2 p);
  const std::vector<int>& fan() const { return fan_; }

  /// True if the quadrilateral around h is strictly convex and the edge is free.
  bool can_flip(int h) const;
  /// Turns the diagonal; the new one runs between the former apexes and is half-edge 3 * (h / 3) of the
  /// result.
  void flip(int h);
  /// True if the origin of h lies inside, on no fixed edge, and its triangles stay positive when it moves to
  /// the target of h.
  bool can_collapse(int h) const;
  /// Moves the origin of h onto its target and takes out the two triangles of the edge. Precondition:
  /// can_collapse(h). The last triangles take the numbers that become free.
  void collapse(int h);
  /// Calls visit(h) for the half-edges that start at v, all round (or from border to border).
  template <class Visit>
  void around(int v, Visit visit) const;

 private:
  int half_edge(int a, int b) const;
  void set(int t, Tri corners);
  void link(int h, int outer, std::uint8_t kind);
  void erase(int t);
  void insert_all(int n);
  void recover(int a, int b, std::uint8_t kind);
  void make_delaunay();
  void carve(int n);

  std::vector<int> rim_, fan_, cavity_, stack_, mark_, start_;
  std::vector<std::array<int, 4>> rim_data_;
  int epoch_ = 0;
};

template <class Conflict>
bool Cdt::grow_cavity(Vec2 p, int t, Conflict conflict) {
  ++epoch_;
  cavity_.clear();
  stack_.clear();
  rim_.clear();
  auto take = [&](int s) {
    mark_[s] = epoch_;
    cavity_.push_back(s);
  };
  auto inside = [&](int h) { return !fixed[h] && opposite[h] >= 0 && mark_[opposite[h] / 3] == epoch_; };
  auto sees = [&](int h) { return orient2d(points[origin(h)], points[target(h)], p) > 0; };
  take(t);
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    if (sees(h)) {
      stack_.push_back(h);
      continue;
    }
    // p lies on this edge: the triangle beyond must go too
    int o = opposite[h];
    if (fixed[h] || o < 0 || cavity_.size() > 1) return false;
    if (!sees(next(o)) || !sees(prev(o))) return false;
    take(o / 3);
    stack_.push_back(next(o));
    stack_.push_back(prev(o));
  }
  for (std::size_t k = 0; k < stack_.size(); ++k) {
    int h = stack_[k], o = opposite[h];
    if (fixed[h] || o < 0 || mark_[o / 3] == epoch_ || !conflict(o / 3)) continue;
    // the cavity stays star-shaped round p, and swallows no vertex
    bool in1 = inside(next(o)), in2 = inside(prev(o));
    if ((in1 && in2) || (!in1 && !sees(next(o))) || (!in2 && !sees(prev(o)))) continue;
    take(o / 3);
    if (!in1) stack_.push_back(next(o));
    if (!in2) stack_.push_back(prev(o));
  }
  for (int s : cavity_)
    for (int h = 3 * s; h < 3 * s + 3; ++h)
      if (!inside(h)) rim_.push_back(h);
  return true;
}

template <class Visit>
void Cdt::around(int v, Visit visit) const {
  int t = at[v], first = 3 * t + (tris[t][0] == v ? 0 : tris[t][1] == v ? 1 : 2), h = first;
  do {
    visit(h);
    h = opposite[prev(h)];
  } while (h >= 0 && h != first);
  if (h == first) return;
  for (h = opposite[first]; h >= 0; h = opposite[next(h)]) visit(next(h));
}

}  // namespace meshpipe
