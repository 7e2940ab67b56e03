// SPDX-License-Identifier: BSD-3-Clause
#include "lib/cdt.h"

#include <algorithm>
#include <deque>
#include <numeric>
#include <string>

#include "lib/error.h"
#include "lib/number.h"

namespace meshpipe {
namespace {

std::string show(Vec2 p) { return "(" + shown(p.x) + ", " + shown(p.y) + ")"; }

// Place of a cell on Hilbert's curve of order 16.
std::uint32_t hilbert(std::uint32_t x, std::uint32_t y) {
  std::uint32_t d = 0;
  for (std::uint32_t s = 1u << 15; s > 0; s >>= 1) {
    std::uint32_t rx = (x & s) > 0, ry = (y & s) > 0;
    d += s * s * ((3 * rx) ^ ry);
    if (ry == 0) {
      if (rx == 1) x = 65535 - x, y = 65535 - y;
      std::swap(x, y);
    }
  }
  return d;
}

// Rounds of doubling size at random, each along Hilbert's curve: expected n log n insertion whatever the
// points (Amenta, Choi, Rote 2003).
std::vector<int> insertion_order(const std::vector<Vec2>& points, Vec2 lo, double extent) {
  int n = (int)points.size();
  std::vector<std::uint64_t> key(n);
  for (int i = 0; i < n; ++i) {
    std::uint64_t r = (i + 1) * 0x9E3779B97F4A7C15ull;
    r = (r ^ (r >> 30)) * 0xBF58476D1CE4E5B9ull;
    r = (r ^ (r >> 27)) * 0x94D049BB133111EBull;
    int round = r >> 63   ? 0
                : r >> 62 ? 1
                : r >> 61 ? 2
                : r >> 60 ? 3
                : r >> 59 ? 4
                : r >> 58 ? 5
                : r >> 57 ? 6
                          : 7;
    auto cell = [&](double x) { return (std::uint32_t)(x * (65535 / extent)); };
    key[i] = (std::uint64_t)(7 - round) << 32 | hilbert(cell(points[i].x - lo.x), cell(points[i].y - lo.y));
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return key[i] != key[j] ? key[i] < key[j] : i < j; });
  return order;
}

}  // namespace

void Cdt::set(int t, Tri corners) {
  tris[t] = corners;
  for (int v : corners) at[v] = t;
  ++version[t];
}

// Puts `outer` across h, or the border if it is -1.
void Cdt::link(int h, int outer, std::uint8_t kind) {
  opposite[h] = outer;
  fixed[h] = kind;
  if (outer >= 0) opposite[outer] = h;
}

int Cdt::walk(Vec2 p, int t, std::uint8_t wall) const {
  int from = -1;
  // a visibility walk may go round in circles in a triangulation that is not Delaunay, unless it does not
  // always try the same edge first (Devillers, Pion, Teillaud 2002); its steps are counted nevertheless
  unsigned random = 12345;
  for (std::size_t step = 0; step < tris.size() + 3; ++step) {
    random = 1664525 * random + 1013904223;
    int out = -1;
    for (int k = 0, h = 3 * t + (int)((random >> 16) % 3); k < 3 && out < 0; ++k, h = next(h))
      if (h != from && orient2d(points[origin(h)], points[target(h)], p) < 0) out = h;
    if (out < 0) return t;
    if (fixed[out] >= wall || opposite[out] < 0) return -1;
    from = opposite[out];
    t = from / 3;
  }
  return -1;
}

int Cdt::fill_cavity(Vec2 p) {
  int v = (int)points.size();
  points.push_back(p);
  at.push_back(-1);
  start_.resize(points.size());
  rim_data_.clear();
  for (int h : rim_) rim_data_.push_back({origin(h), target(h), opposite[h], fixed[h]});
  fan_ = cavity_;
  for (int t = (int)tris.size(); fan_.size() < rim_.size(); ++t) fan_.push_back(t);
  if (fan_.back() >= (int)tris.size()) {
    std::size_t n = fan_.back() + 1;
    tris.resize(n);
    opposite.resize(3 * n, -1);
    fixed.resize(3 * n, free_edge);
    version.resize(n, 0);
    mark_.resize(n, 0);
  }
  for (std::size_t k = 0; k < fan_.size(); ++k) {
    auto [a, b, outer, kind] = rim_data_[k];
    int t = fan_[k];
    set(t, {a, b, v});
    link(3 * t, outer, (std::uint8_t)kind);
    fixed[3 * t + 1] = fixed[3 * t + 2] = free_edge;
    start_[a] = t;
  }
  for (int t : fan_) {
    int s = start_[tris[t][1]];
    opposite[3 * t + 1] = 3 * s + 2;
    opposite[3 * s + 2] = 3 * t + 1;
  }
  return v;
}

bool Cdt::can_flip(int h) const {
  int o = opposite[h];
  if (fixed[h] || o < 0) return false;
  Vec2 c = points[apex(h)], d = points[apex(o)];
  return orient2d(d, points[target(h)], c) > 0 && orient2d(c, points[origin(h)], d) > 0;
}

void Cdt::flip(int h) {
  //     c            c        t = abc, s = bad become
  //   / t \        / | \      t = dca: the new diagonal first, s = cdb
  //  a --- b  ->  a t|s b
  //   \ s /        \ | /
  //     d            d
  int o = opposite[h], t = h / 3, s = o / 3;
  int a = origin(h), b = target(h), c = apex(h), d = apex(o);
  struct Outer {
    int opposite;
    std::uint8_t kind;
  };
  auto outer = [&](int e) { return Outer{opposite[e], fixed[e]}; };
  Outer bc = outer(next(h)), ca = outer(prev(h)), ad = outer(next(o)), db = outer(prev(o));
  set(t, {d, c, a});
  set(s, {c, d, b});
  fixed[3 * s] = free_edge;
  link(3 * t, 3 * s, free_edge);
  link(3 * t + 1, ca.opposite, ca.kind);
  link(3 * t + 2, ad.opposite, ad.kind);
  link(3 * s + 1, db.opposite, db.kind);
  link(3 * s + 2, bc.opposite, bc.kind);
}

bool Cdt::can_collapse(int h) const {
  const int w = target(h);
  for (int e = h;;) {
    if (fixed[e] || opposite[e] < 0) return false;
    if (target(e) != w && apex(e) != w && orient2d(points[w], points[target(e)], points[apex(e)]) <= 0)
      return false;
    e = opposite[prev(e)];
    if (e < 0) return false;
    if (e == h) return true;
  }
}

void Cdt::collapse(int h) {
  //      x            x
  //    / | \        / |
  //  ..  v--w   ->  .. w    t = vwx and s = wvy go; what is beyond their other sides meets
  //    \ | /        \ |
  //      y            y
  const int v = origin(h), w = target(h), o = opposite[h], t = h / 3, s = o / 3;
  const int x = apex(h), y = apex(o);
  for (int e = opposite[prev(h)]; e / 3 != s; e = opposite[prev(e)]) {
    tris[e / 3][e % 3] = w;
    ++version[e / 3];
  }
  // the edges of v have a triangle on either side, those beyond may be on the border
  const int xv = opposite[prev(h)], vy = opposite[next(o)];
  link(xv, opposite[next(h)], fixed[next(h)]);
  link(vy, opposite[prev(o)], fixed[prev(o)]);
  at[v] = -1;
  at[w] = at[x] = xv / 3;
  at[y] = vy / 3;
  erase(std::max(t, s));
  erase(std::min(t, s));
}

// Takes out a triangle that nothing links to; the last one takes its number.
void Cdt::erase(int t) {
  const int last = (int)tris.size() - 1;
  ++version[t];
  if (t != last) {
    set(t, tris[last]);
    for (int i = 0; i < 3; ++i) link(3 * t + i, opposite[3 * last + i], fixed[3 * last + i]);
  }
  tris.pop_back();
  opposite.resize(3 * last);
  fixed.resize(3 * last);
  version.pop_back();
  mark_.pop_back();
}

int Cdt::half_edge(int a, int b) const {
  int found = -1;
  around(a, [&](int h) {
    if (target(h) == b) found = h;
  });
  return found;
}

Cdt::Cdt(std::vector<Vec2> input, const std::vector<FixedEdge>& segments) : points(std::move(input)) {
  int n = (int)points.size();
  insert_all(n);
  for (const FixedEdge& s : segments) recover(s.a, s.b, s.border ? border_segment : inner_segment);
  make_delaunay();
  carve(n);
}

void Cdt::insert_all(int n) {
  if (n < 3) throw GoalMissed("no region with " + std::to_string(n) + " points");
  Vec2 lo = points[0], hi = points[0];
  for (Vec2 p : points) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
  }
  double extent = std::max(hi.x - lo.x, hi.y - lo.y);
  if (!(extent > 0)) throw GoalMissed("all points are at " + show(lo));
  std::vector<int> order = insertion_order(points, lo, extent);
  // a triangle far around everything; its corners get the numbers n, n + 1, n + 2
  std::vector<Vec2> input = std::move(points);
  Vec2 c = 0.5 * (lo + hi);
  points.assign(n, c);
  points.push_back(c + extent * Vec2{-20, -16});
  points.push_back(c + extent * Vec2{20, -15});
  points.push_back(c + extent * Vec2{1, 22});
  at.assign(n + 3, -1);
  tris = {{n, n + 1, n + 2}};
  opposite.assign(3, -1);
  fixed.assign(3, free_edge);
  version.assign(1, 0);
  mark_.assign(1, 0);
  for (int i = 0; i < 3; ++i) at[n + i] = 0;
  int t = 0;
  for (int i : order) {
    Vec2 p = input[i];
    t = walk(p, t);
    bool new_point = t >= 0 && grow_cavity(p, t, [&](int s) {
                       return incircle(points[tris[s][0]], points[tris[s][1]], points[tris[s][2]], p) > 0;
                     });
    if (!new_point) throw GoalMissed("two points at " + show(p));
    // fill_cavity appends; here the vertex has its number already
    int v = fill_cavity(p);
    points.pop_back();
    at.pop_back();
    points[i] = p;
    at[i] = fan_[0];
    for (int s : fan_)
      for (int& w : tris[s])
        if (w == v) w = i;
    t = fan_[0];
  }
}

void Cdt::recover(int a, int b, std::uint8_t kind) {
  auto fail = [&](const char* what, int v) {
    throw GoalMissed("the segment " + show(points[a]) + " " + show(points[b]) + " " + what + " " +
                     show(points[v]));
  };
  if (a == b) fail("has no length at", a);
  int h = half_edge(a, b);
  if (h < 0) {
    // the edges that cross it, found by marching from a to b
    std::deque<std::pair<int, int>> crossing;
    int first = -1;
    around(a, [&](int e) {
      int x = orient2d(points[a], points[b], points[target(e)]);
      if (x == 0 && dot(points[target(e)] - points[a], points[b] - points[a]) > 0)
        fail("runs through", target(e));
      if (x < 0 && orient2d(points[a], points[b], points[apex(e)]) > 0) first = next(e);
    });
    for (int e = first;;) {
      if (fixed[e]) fail("crosses one at", origin(e));
      crossing.push_back({origin(e), target(e)});
      int o = opposite[e], z = apex(o);
      if (z == b) break;
      int side = orient2d(points[a], points[b], points[z]);
      if (side == 0) fail("runs through", z);
      e = side > 0 ? next(o) : prev(o);
    }
    // flip them away (Sloan 1993)
    while (!crossing.empty()) {
      auto [x, y] = crossing.front();
      crossing.pop_front();
      int e = half_edge(x, y);
      if (!can_flip(e)) {
        crossing.push_back({x, y});
        continue;
      }
      flip(e);
      e = 3 * (e / 3);
      int c = origin(e), d = target(e);
      if (c != a && c != b && d != a && d != b &&
          orient2d(points[a], points[b], points[c]) * orient2d(points[a], points[b], points[d]) < 0)
        crossing.push_back({c, d});
    }
    h = half_edge(a, b);
  }
  if (fixed[h]) fail("lies on another at", a);
  fixed[h] = fixed[opposite[h]] = kind;
}

void Cdt::make_delaunay() {
  std::vector<int> todo(3 * tris.size());
  std::iota(todo.begin(), todo.end(), 0);
  while (!todo.empty()) {
    int h = todo.back(), o = opposite[h];
    todo.pop_back();
    if (o < 0 || fixed[h]) continue;
    if (incircle(points[origin(h)], points[target(h)], points[apex(h)], points[apex(o)]) <= 0) continue;
    int t = h / 3, s = o / 3;
    flip(h);
    for (int e : {3 * t + 1, 3 * t + 2, 3 * s + 1, 3 * s + 2}) todo.push_back(e);
  }
}

void Cdt::carve(int n) {
  // outside is 0; a border segment leads to the other side
  std::vector<signed char> side(tris.size(), -1);
  std::vector<int> todo{at[n]};
  side[at[n]] = 0;
  while (!todo.empty()) {
    int t = todo.back();
    todo.pop_back();
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (opposite[h] < 0) continue;
      signed char s = side[t] ^ (fixed[h] == border_segment);
      int u = opposite[h] / 3;
      if (side[u] < 0) {
        side[u] = s;
        todo.push_back(u);
      } else if (side[u] != s) {
        throw GoalMissed("the border is not closed at " + show(points[origin(h)]));
      }
    }
  }
  std::vector<int> number(tris.size(), -1);
  int m = 0;
  for (std::size_t t = 0; t < tris.size(); ++t)
    if (side[t] == 1) number[t] = m++;
  if (m == 0) throw GoalMissed("no region inside the border at " + show(points[0]));
  std::fill(at.begin(), at.end(), -1);
  for (std::size_t t = 0; t < tris.size(); ++t) {
    int k = number[t];
    if (k < 0) continue;
    for (int i = 0; i < 3; ++i) {
      int o = opposite[3 * t + i];
      at[tris[t][i]] = k;
      opposite[3 * k + i] = o < 0 || number[o / 3] < 0 ? -1 : 3 * number[o / 3] + o % 3;
      fixed[3 * k + i] = fixed[3 * t + i];
    }
    tris[k] = tris[t];
  }
  tris.resize(m);
  opposite.resize(3 * m);
  fixed.resize(3 * m);
  version.assign(m, 0);
  mark_.assign(m, 0);
  epoch_ = 0;
  points.resize(n);
  at.resize(n);
  for (int v = 0; v < n; ++v)
    if (at[v] < 0) throw GoalMissed("the point " + show(points[v]) + " lies outside the border");
}

}  // namespace meshpipe
