// SPDX-License-Identifier: BSD-3-Clause
#include "lib/resolve/plane_triangulation.h"

#include "lib/core/fan.h"

namespace meshpipe {

void PlaneTriangulation::clear() {
  tris.clear();
  opposite.clear();
  line.clear();
}

int PlaneTriangulation::add_triangle() {
  tris.push_back({-1, -1, -1});
  opposite.resize(3 * tris.size(), -1);
  line.resize(3 * tris.size(), -1);
  return (int)tris.size() - 1;
}

void PlaneTriangulation::set(int t, const Tri& corners) {
  tris[t] = corners;
  for (int v : corners) {
    if (v >= (int)at.size()) at.resize(v + 1 + v / 2);
    at[v] = t;
  }
}

void PlaneTriangulation::link(int h, int outer, int on_line) {
  opposite[h] = outer;
  line[h] = on_line;
  if (outer >= 0) opposite[outer] = h, line[outer] = on_line;
}

void PlaneTriangulation::fix(int h, int on_line) {
  if (fixed(h)) return;
  line[h] = on_line;
  if (opposite[h] >= 0) line[opposite[h]] = on_line;
}

int PlaneTriangulation::leaving(int p) const {
  const int t = at[p];
  return 3 * t + (tris[t][0] == p ? 0 : tris[t][1] == p ? 1 : 2);
}

int PlaneTriangulation::half_edge(int p, int q) const {
  int found = -1;
  for_each_spoke(opposite, leaving(p), [&](int h) {
    if (to(h) == q) found = h;
    if (apex(h) == q && opposite[prev(h)] < 0) found = prev(h);
    return found < 0;
  });
  return found;
}

void PlaneTriangulation::flip(int h) {
  //     c            c        t = abc, s = bad become
  //   / t \        / | \      t = dca: the new diagonal first, s = cdb
  //  a --- b  ->  a t|s b
  //   \ s /        \ | /
  //     d            d
  const int o = opposite[h], t = h / 3, s = o / 3;
  const int a = from(h), b = to(h), c = apex(h), d = apex(o);
  auto outer = [&](int e) { return std::pair{opposite[e], line[e]}; };
  const auto bc = outer(next(h)), ca = outer(prev(h)), ad = outer(next(o)), db = outer(prev(o));
  set(t, {d, c, a});
  set(s, {c, d, b});
  link(3 * t, 3 * s, -1);
  link(3 * t + 1, ca.first, ca.second);
  link(3 * t + 2, ad.first, ad.second);
  link(3 * s + 1, db.first, db.second);
  link(3 * s + 2, bc.first, bc.second);
}

void PlaneTriangulation::split_triangle(int t, int p) {
  const auto [a, b, c] = tris[t];
  const int u = add_triangle(), v = add_triangle();
  for (const auto& [k, to] : {std::pair{1, u}, {2, v}}) link(3 * to, opposite[3 * t + k], line[3 * t + k]);
  set(t, {a, b, p});
  set(u, {b, c, p});
  set(v, {c, a, p});
  link(3 * t + 1, 3 * u + 2, -1);
  link(3 * u + 1, 3 * v + 2, -1);
  link(3 * v + 1, 3 * t + 2, -1);
}

void PlaneTriangulation::split_edge(int h, int p) {
  // half-edge h = ab of t = abc, o = ba of s = bad: to apc, pbc, bpd, pad
  const int o = opposite[h], on_line = line[h], t = h / 3;
  const int a = from(h), b = to(h), c = apex(h), u = add_triangle();
  const auto bc = std::pair{opposite[next(h)], line[next(h)]},
             ca = std::pair{opposite[prev(h)], line[prev(h)]};
  int s = -1, v = -1, d = -1;
  std::pair<int, int> ad, db;
  if (o >= 0) {
    s = o / 3, d = apex(o), v = add_triangle();
    ad = {opposite[next(o)], line[next(o)]}, db = {opposite[prev(o)], line[prev(o)]};
  }
  set(t, {a, p, c});
  set(u, {p, b, c});
  link(3 * t + 1, 3 * u + 2, -1);
  link(3 * t + 2, ca.first, ca.second);
  link(3 * u + 1, bc.first, bc.second);
  link(3 * t, -1, on_line);
  link(3 * u, -1, on_line);
  if (o < 0) return;
  set(s, {b, p, d});
  set(v, {p, a, d});
  link(3 * s + 1, 3 * v + 2, -1);
  link(3 * s + 2, db.first, db.second);
  link(3 * v + 1, ad.first, ad.second);
  link(3 * s, 3 * u, on_line);
  link(3 * v, 3 * t, on_line);
}

}  // namespace meshpipe
