// SPDX-License-Identifier: BSD-3-Clause
// A plane triangulation with fixed edges: constrained Delaunay at first, then changed by the meshers in a
// metric of theirs.
#pragma once
#include <cstdint>
#include <vector>

#include "lib/core/mesh.h"
#include "lib/core/predicates.h"

namespace meshpipe {

/// A straight edge between two points that the triangulation must have; those with `border` bound the region.
struct FixedEdge {
  int a, b;
  bool border;
};

/// Triangles with half-edges as in lib/core/mesh.h, all positive by the exact predicate, always.
struct Cdt {
  enum : std::uint8_t { free_edge = 0, inner_segment = 1, border_segment = 2 };

  std::vector<Vec2> points;
  std::vector<Tri> tris;
  std::vector<int> opposite;        ///< -1 on the border
  std::vector<std::uint8_t> fixed;  ///< per half-edge: never flipped nor crossed
  std::vector<int> at;              ///< a triangle of each vertex, -1 for vertices that were collapsed
  std::vector<int> version;         ///< per triangle: counts how often it was replaced

  /// Computes the constrained Delaunay triangulation of the region that the border segments bound: what an
  /// odd number of them separates from infinity. Vertex i is points[i].
  /// Throws: GoalMissed naming a point where two points coincide, segments cross or touch, a border is not
  /// closed, or a point lies outside.
  Cdt(std::vector<Vec2> points, const std::vector<FixedEdge>& segments);

  int origin(int h) const { return tris[h / 3][h % 3]; }
  int target(int h) const { return tris[h / 3][(h + 1) % 3]; }
  int apex(int h) const { return tris[h / 3][(h + 2) % 3]; }

  /// Returns the triangle that holds p, walking from triangle t; -1 if p is outside, or if an edge with
  /// fixed[h] >= `barrier` is in the way.
  int walk(Vec2 p, int t, std::uint8_t barrier = inner_segment) const;
  /// Returns the half-edge from vertex a to b, or -1 if there is none.
  int half_edge(int a, int b) const;

  /// Returns whether the edge of h is free and its two triangles form a strictly convex quadrilateral.
  bool can_flip(int h) const;
  /// Replaces the edge of h by the other diagonal of its two triangles, which becomes half-edge 3 * (h / 3).
  /// Requires: can_flip(h).
  void flip(int h);
  /// Returns whether the origin of h lies inside and on no fixed edge, and its triangles stay positive when
  /// it moves to the target of h.
  bool can_collapse(int h) const;
  /// Moves the origin of h onto its target and removes the two triangles of the edge; the last triangles of
  /// the list take their numbers. Requires: can_collapse(h).
  void collapse(int h);
  /// Calls visit(h) for every half-edge that starts at v.
  template <class Visit>
  void around(int v, Visit visit) const;

  /// Sets the corners of triangle t, counts its version up, and makes it the triangle `at` each corner.
  void set(int t, Tri corners);
  /// Makes h and `outer` opposite half-edges (-1: h is on the border), and sets fixed[h].
  void link(int h, int outer, std::uint8_t kind);
  /// Removes a triangle to which no half-edge is linked; the last triangle of the list takes its number.
  void erase(int t);
};

/// The triangles that a new point replaces, and the fan that replaces them. Keeps its memory between points.
class Cavity {
 public:
  /// Collects triangles from t, which holds p, over their free edges: those for which conflict(triangle)
  /// holds and whose union with the others p sees completely. False if p lies on a vertex or fixed edge.
  template <class Conflict>
  bool grow(const Cdt& cdt, Vec2 p, int t, Conflict conflict);
  /// Returns the half-edges of the cavity's border, each in a triangle inside.
  const std::vector<int>& rim() const { return rim_; }
  /// Replaces the collected triangles by the fan of a new vertex at p, the last vertex, which it returns.
  int fill(Cdt& cdt, Vec2 p);
  /// Returns the triangles of the new vertex, which is their third corner.
  const std::vector<int>& fan() const { return fan_; }

 private:
  std::vector<int> rim_, fan_, cavity_, stack_, start_;
  std::vector<int> mark_;  ///< per triangle: the last cavity that took it
  std::vector<std::array<int, 4>> rim_data_;
  int epoch_ = 0;
};

template <class Conflict>
bool Cavity::grow(const Cdt& cdt, Vec2 p, int t, Conflict conflict) {
  const auto& opposite = cdt.opposite;
  const auto& fixed = cdt.fixed;
  if (mark_.size() < cdt.tris.size()) mark_.resize(cdt.tris.size(), 0);
  ++epoch_;
  cavity_.clear();
  stack_.clear();
  rim_.clear();
  auto take = [&](int s) {
    mark_[s] = epoch_;
    cavity_.push_back(s);
  };
  auto inside = [&](int h) { return !fixed[h] && opposite[h] >= 0 && mark_[opposite[h] / 3] == epoch_; };
  auto sees = [&](int h) { return orient2d(cdt.points[cdt.origin(h)], cdt.points[cdt.target(h)], p) > 0; };
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
    // the cavity stays star-shaped around p, and swallows no vertex
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
