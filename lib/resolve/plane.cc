// SPDX-License-Identifier: BSD-3-Clause
#include "lib/resolve/plane.h"

#include <algorithm>
#include <deque>

#include "lib/core/error.h"
#include "lib/core/fan.h"
#include "lib/core/lists.h"
#include "lib/core/predicates.h"

namespace meshpipe {

void TriangleArrangement::start(const Tri& corners) {
  mesh_.clear();
  lines_.clear();
  view_ = points_.view(corners);
  mesh_.add_triangle();
  mesh_.set(0, corners);
  for (int i = 0; i < 3; ++i) {
    lines_.push_back({corners[i], corners[(i + 1) % 3]});
    mesh_.link(i, -1, i);
  }
  last_ = 0;
}

bool TriangleArrangement::can_flip(int h) const {
  const int o = mesh_.opposite[h];
  if (o < 0 || mesh_.fixed(h)) return false;
  return turn(mesh_.apex(o), mesh_.to(h), mesh_.apex(h)) > 0 &&
         turn(mesh_.apex(h), mesh_.from(h), mesh_.apex(o)) > 0;
}

/// Returns the triangle that p lies in, and in `on` its half-edge that p lies on, or -1.
int TriangleArrangement::locate(int p, int& on) const {
  // a visibility walk with changing first edges ends almost surely (Devillers, Pion, Teillaud 2002)
  int t = last_, come = -1;
  unsigned random = 12345;
  const int n = (int)mesh_.tris.size();
  for (int k = 0; k < 10 * n + 100; ++k) {
    random = 1664525 * random + 1013904223;
    int out = on = -1;
    for (int i = 0; i < 3 && out < 0; ++i) {
      const int h = 3 * t + (int)((random >> 16) + i) % 3;
      const int side = h == come ? 1 : turn(mesh_.from(h), mesh_.to(h), p);
      if (side < 0) out = h;
      if (side == 0) on = h;
    }
    if (out < 0) return t;
    come = mesh_.opposite[out];
    if (come < 0) break;
    t = come / 3;
  }
  throw Error("a point of an intersection was not found in its triangle");
}

void TriangleArrangement::insert(int p) {
  int on = -1;
  const int t = locate(p, on);
  const Tri& v = mesh_.tris[t];
  if (std::find(v.begin(), v.end(), p) != v.end()) return;
  if (on >= 0)
    mesh_.split_edge(on, p);
  else
    mesh_.split_triangle(t, p);
  last_ = mesh_.at[p];
  std::vector<int> rim;
  for_each_spoke(mesh_.opposite, mesh_.leaving(p), [&](int h) { rim.push_back(next(h)); });
  improve(std::move(rim));
}

bool TriangleArrangement::ahead(int p, int q, int r) const {
  for (int k : {view_.i, view_.j})
    if (const int c = points_.compare(p, q, k); c != 0) return points_.compare(p, r, k) == c;
  return false;
}

void TriangleArrangement::insert(int p, int q) {
  lines_.push_back({p, q});
  const int on_line = (int)lines_.size() - 1;
  while (p != q) p = step(p, on_line);
}

/// Goes on from p, on the line, to the next point on it: a vertex, or where a fixed edge is crossed. Makes
/// the way there a fixed edge.
int TriangleArrangement::step(int p, int on_line) {
  const int first = lines_[on_line][0], last = lines_[on_line][1];
  auto side = [&](int v) { return turn(first, last, v); };
  int along = -1, crossing = -1;
  for_each_spoke(mesh_.opposite, mesh_.leaving(p), [&](int h) {
    const int a = mesh_.to(h), b = mesh_.apex(h), at_a = side(a), at_b = side(b);
    if (at_a == 0 && ahead(p, last, a))
      along = h;
    else if (at_b == 0 && ahead(p, last, b))
      along = prev(h);
    else if (at_a < 0 && at_b > 0)
      crossing = next(h);
    return along < 0 && crossing < 0;
  });
  if (along >= 0) {
    mesh_.fix(along, on_line);
    return mesh_.from(along) == p ? mesh_.to(along) : mesh_.from(along);
  }
  if (crossing < 0) throw Error("a segment of an intersection leaves its triangle");
  std::vector<std::array<int, 2>> crossed;
  int z = -1;
  for (int e = crossing; z < 0;) {
    if (mesh_.fixed(e)) {
      const auto [a, b] = lines_[mesh_.line[e]];
      z = points_.line_and_line(first, last, a, b, view_);
      mesh_.split_edge(e, z);
      break;
    }
    crossed.push_back({mesh_.from(e), mesh_.to(e)});
    const int o = mesh_.opposite[e], v = mesh_.apex(o), at_v = side(v);
    if (at_v == 0) z = v;
    e = at_v > 0 ? next(o) : prev(o);
  }
  clear_way(p, z, crossed);
  mesh_.fix(mesh_.half_edge(p, z), on_line);
  return z;
}

/// Flips the edges between p and q away (Sloan 1993).
void TriangleArrangement::clear_way(int p, int q, const std::vector<std::array<int, 2>>& crossed) {
  std::deque<std::array<int, 2>> todo(crossed.begin(), crossed.end());
  while (!todo.empty()) {
    const auto [a, b] = todo.front();
    todo.pop_front();
    const int h = mesh_.half_edge(a, b);
    if (!can_flip(h)) {
      todo.push_back({a, b});
      continue;
    }
    mesh_.flip(h);
    const int c = mesh_.from(3 * (h / 3)), d = mesh_.to(3 * (h / 3));
    if (c != p && c != q && d != p && d != q && turn(p, q, c) * turn(p, q, d) < 0) todo.push_back({c, d});
  }
}

void TriangleArrangement::improve() { improve(identity(mesh_.opposite.size())); }

void TriangleArrangement::improve(std::vector<int> todo) {
  auto seen = [&](int v) {
    const Vec3& p = points_.near(v);
    const double x[3] = {p.x, p.y, p.z};
    return Vec2{x[view_.i], x[view_.j]};
  };
  // rounded coordinates might let this go around in circles
  for (std::size_t flips = 0, most = 10 * mesh_.opposite.size(); !todo.empty() && flips < most;) {
    const int h = todo.back(), o = mesh_.opposite[h];
    todo.pop_back();
    if (o < 0 || mesh_.fixed(h)) continue;
    if (incircle(seen(mesh_.from(h)), seen(mesh_.to(h)), seen(mesh_.apex(h)), seen(mesh_.apex(o))) <= 0 ||
        !can_flip(h))
      continue;
    const int t = h / 3, s = o / 3;
    mesh_.flip(h);
    ++flips;
    for (int e : {3 * t + 1, 3 * t + 2, 3 * s + 1, 3 * s + 2}) todo.push_back(e);
  }
}

}  // namespace meshpipe
