// SPDX-License-Identifier: BSD-3-Clause
// Edges of four or more triangles: pairs of them bound the same solid, so that closed surfaces stay closed.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "lib/clean/repair.h"
#include "lib/core/edges.h"
#include "lib/core/fan.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

/// Radians: triangles closer than this lie on one another. Rounding to single precision turns triangles of
/// ordinary shape by 1e-6.
constexpr double coplanar = 1e-5;

/// How the triangles of an edge are paired: those that bound the same solid, those that bound the same gap
/// between solids, or not at all.
enum Mode : char { solids, gaps, none };

/// An edge of more than two triangles: its half-edges counterclockwise around it.
struct Star {
  int first, count;
  Mode mode;
  bool touches;  ///< triangles of different solids lie on one another
};

struct Stars {
  std::vector<int> half_edge;
  std::vector<Star> star;
  std::span<int> of(const Star& s) { return std::span(half_edge).subspan(s.first, s.count); }
};

/// Whether a solid begins at the triangle of h, seen counterclockwise around the edge from the smaller to the
/// larger vertex.
bool begins(const Repair& r, int h) { return origin(r.tris, h) > target(r.tris, h); }

/// Sorts the half-edges of an edge counterclockwise; where triangles lie on one another, ends of solids come
/// before beginnings, as no solid is between them. Returns false if a triangle has no height.
bool sort_around(const Repair& r, const std::vector<Vec3>& points, std::span<int> edge, bool& touches) {
  auto point = [&](int v) { return points[r.vertex[v]]; };
  const int h = edge[0], v = std::min(origin(r.tris, h), target(r.tris, h)),
            w = std::max(origin(r.tris, h), target(r.tris, h));
  const Vec3 a = point(v), axis = normalized(point(w) - a);
  auto aside = [&](int g) {
    const Vec3 d = point(origin(r.tris, prev(g))) - a;
    return d - dot(d, axis) * axis;
  };
  const Vec3 x = normalized(aside(h)), y = cross(axis, x);
  std::vector<std::pair<double, int>> order;
  for (int g : edge) {
    const Vec3 d = aside(g);
    if (!(norm(d) > 0)) return false;
    order.push_back({std::atan2(dot(d, y), dot(d, x)), g});
  }
  std::sort(order.begin(), order.end());
  // start behind the widest gap, so that triangles on one another stay together
  const std::size_t n = order.size();
  std::size_t start = 0;
  double widest = order[0].first + 2 * std::numbers::pi - order[n - 1].first;
  for (std::size_t i = 1; i < n; ++i)
    if (const double gap = order[i].first - order[i - 1].first; gap > widest) widest = gap, start = i;
  std::rotate(order.begin(), order.begin() + start, order.end());
  auto turn = [](double from, double to) { return to < from ? to - from + 2 * std::numbers::pi : to - from; };
  touches = false;
  for (std::size_t i = 0; i < n;) {
    std::size_t j = i + 1;
    while (j < n && turn(order[j - 1].first, order[j].first) < coplanar) ++j;
    // further ties by number, so that the order does not depend on which end of the edge comes first
    std::sort(order.begin() + i, order.begin() + j, [&](const auto& o, const auto& p) {
      const bool b = begins(r, o.second), c = begins(r, p.second);
      return b != c ? c : b ? o.second > p.second : o.second < p.second;
    });
    const bool ends = !begins(r, order[i].second);
    touches = touches || (ends && begins(r, order[j - 1].second));
    i = j;
  }
  for (std::size_t i = 0; i < n; ++i) edge[i] = order[i].second;
  return true;
}

Stars find_stars(const Repair& r, const std::vector<Vec3>& points) {
  Stars s;
  for_each_edge(r.tris, (int)r.vertex.size(), [&](std::span<const EdgeUse> uses) {
    if (uses.size() < 3) return;
    const int first = (int)s.half_edge.size(), n = (int)uses.size();
    int begin = 0;
    for (EdgeUse e : uses) {
      s.half_edge.push_back(half_edge(e));
      begin += begins(r, half_edge(e));
    }
    Star& star = s.star.emplace_back(Star{first, n, none, false});
    if (2 * begin == n && sort_around(r, points, s.of(star), star.touches)) star.mode = solids;
  });
  return s;
}

/// Leaves the stars of complexes alone that are not closed: there are borders, or edges whose triangles do
/// not bound solids, so that sheets meet rather than solids.
void keep_closed(const Repair& r, Stars& stars) {
  const int n = (int)r.tris.size();
  UnionFind complex(n);
  std::vector<char> open(n, 0), starred(r.opposite.size(), 0);
  for (const Star& s : stars.star)
    for (int h : stars.of(s)) {
      starred[h] = 1;
      complex.join(h / 3, stars.half_edge[s.first] / 3);
      if (s.mode == none) open[h / 3] = 1;
    }
  for (int h = 0; h < (int)r.opposite.size(); ++h)
    if (r.opposite[h] >= 0)
      complex.join(h / 3, r.opposite[h] / 3);
    else if (!starred[h])
      open[h / 3] = 1;
  for (int t = 0; t < n; ++t)
    if (open[t]) open[complex.find(t)] = 1;
  for (Star& s : stars.star)
    if (open[complex.find(stars.half_edge[s.first] / 3)]) s.mode = none;
}

/// Connects the triangles of an edge as brackets are matched, so that no two pairs cross.
void connect(Repair& r, std::span<const int> edge, Mode mode) {
  auto opens = [&](int h) { return begins(r, h) == (mode == solids); };
  int depth = 0, least = 0, start = 0;
  const int n = (int)edge.size();
  for (int i = 0; i < n; ++i)
    if ((depth += opens(edge[i]) ? 1 : -1) < least) least = depth, start = i + 1;
  std::vector<int> open;
  for (int i = 0; i < n; ++i) {
    const int h = edge[(start + i) % n];
    if (opens(h)) {
      open.push_back(h);
      continue;
    }
    r.opposite[h] = open.back();
    r.opposite[open.back()] = h;
    open.pop_back();
  }
}

/// Numbers the fans of the triangles at the ends of stars, by corner; -1 elsewhere.
std::vector<int> number_fans(const Repair& r, const Stars& stars) {
  std::vector<int> fan(r.opposite.size(), -1);
  int n = 0;
  for (int h : stars.half_edge)
    for (int corner : {h, next(h)}) {
      if (fan[corner] >= 0) continue;
      for_each_spoke(r.opposite, corner, [&](int g) { fan[g] = n; });
      ++n;
    }
  return fan;
}

/// Whether two pairs of an edge are in the same fan at both ends: then copies of vertices do not separate
/// them.
bool ambiguous(const Repair& r, std::span<const int> edge, const std::vector<int>& fan) {
  std::vector<std::pair<int, int>> ends;
  for (int h : edge)
    ends.push_back(begins(r, h) ? std::pair{fan[next(h)], fan[h]} : std::pair{fan[h], fan[next(h)]});
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 2; i < ends.size(); ++i)
    if (ends[i] == ends[i - 2]) return true;
  return false;
}

}  // namespace

int pair_edges(Repair& r, const std::vector<Vec3>& points) {
  if (std::find(r.split.begin(), r.split.end(), 1) == r.split.end()) return 0;
  Stars stars = find_stars(r, points);
  keep_closed(r, stars);
  for (const Star& s : stars.star)
    if (s.mode != none) connect(r, stars.of(s), s.mode);
  for (bool again = true; again;) {  // every pass opens an edge or pairs it the other way, at most once each
    again = false;
    const std::vector<int> fan = number_fans(r, stars);
    for (Star& s : stars.star) {
      if (s.mode == none || !ambiguous(r, stars.of(s), fan)) continue;
      again = true;
      s.mode = s.mode == solids && !s.touches ? gaps : none;
      for (int h : stars.of(s)) r.opposite[h] = -1;
      if (s.mode != none) connect(r, stars.of(s), s.mode);
    }
  }
  return (int)std::count_if(stars.star.begin(), stars.star.end(),
                            [](const Star& s) { return s.mode != none; });
}

}  // namespace meshpipe
