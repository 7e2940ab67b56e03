// SPDX-License-Identifier: BSD-3-Clause
// The interfaces between parts as curves.
#pragma once
#include <algorithm>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// A maximal run of interface edges between parts a < b, a on its left; closed, or from border or junction to
/// another.
struct Curve {
  int a, b;
  std::vector<int> half_edges;
};

/// Finds all curves of a surface with a face column `part`, those with ends first.
std::vector<Curve> find_curves(const CutSurface& cut);

inline bool is_closed(const Mesh& m, const Curve& c) {
  return target(m.tris, c.half_edges.back()) == origin(m.tris, c.half_edges.front());
}

/// A curve by the ends of an edge in its middle: unlike half-edges these last while other curves are
/// straightened.
using Handle = std::pair<int, int>;
Handle handle_of(const Mesh& m, const Curve& c);

/// Returns whether one of the handles (sorted) is of the curve.
bool has_handle(const Mesh& m, const Curve& c, const std::vector<Handle>& handles);

/// Two parts, the lower number first.
using Pair = std::pair<int, int>;

/// Gives pairs of parts whose curves share a junction different colors, 0, 1, ...: curves of a color may move
/// together.
std::map<Pair, int> color_pairs(const Surface& s, const std::vector<Curve>& curves);

/// Returns the largest angle by which a curve turns on the surface between edges that skipped(half_edge) does
/// not name, in radians; 0: it is straight.
template <class Skipped>
double sharpest_turn(const CutSurface& cut, const Curve& c, Skipped skipped) {
  const Surface& s = cut.surface;
  const std::vector<int>& opposite = cut.opposite;
  double sharpest = 0;
  const std::size_t n = c.half_edges.size();
  const bool closed = is_closed(s, c);
  for (std::size_t i = closed ? 0 : 1; i < n; ++i) {
    const int to = c.half_edges[i > 0 ? i - 1 : n - 1], from = c.half_edges[i];
    if (skipped(to) || skipped(from)) continue;
    const Vec3 p = s.points[origin(s.tris, from)];
    auto corner = [&](int h) {
      return angle(s.points[target(s.tris, h)] - p, s.points[origin(s.tris, prev(h))] - p);
    };
    double left = 0, right = 0;
    int h = from;
    for (; h >= 0 && h != opposite[to]; h = opposite[prev(h)]) left += corner(h);
    for (; h >= 0 && h != from; h = opposite[prev(h)]) right += corner(h);
    if (h >= 0) sharpest = std::max(sharpest, std::numbers::pi * std::abs(left - right) / (left + right));
  }
  return sharpest;
}

}  // namespace meshpipe
