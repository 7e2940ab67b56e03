// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/cdt.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <string>

#include "lib/core/error.h"
#include "lib/core/failure_facts.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/core/random.h"

namespace meshpipe {
namespace {

std::string show(Vec2 p) { return "(" + shown(p.x) + ", " + shown(p.y) + ")"; }

[[noreturn]] void fail_at(const std::string& what, Vec2 p, const std::string& more = "") {
  FailureFacts facts;
  facts.place = {p.x, p.y, 0};
  facts.in_plane = true;
  throw Informed<GoalMissed>(what + show(p) + more, facts);
}

/// Returns the place of a square on Hilbert's curve of order 16.
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

/// Returns an order of insertion in random rounds of doubling size, each along Hilbert's curve: expected
/// n log n time for any points (Amenta, Choi, Rote 2003).
std::vector<int> insertion_order(const std::vector<Vec2>& points, Vec2 lo, double extent) {
  constexpr int rounds = 8;
  int n = (int)points.size();
  std::vector<std::uint64_t> key(n);
  Random random(0);
  for (int i = 0; i < n; ++i) {
    const int round = std::min(std::countl_zero(random.bits()), rounds - 1);
    auto column = [&](double x) { return (std::uint32_t)(x * (65535 / extent)); };
    key[i] = (std::uint64_t)(rounds - 1 - round) << 32 |
             hilbert(column(points[i].x - lo.x), column(points[i].y - lo.y));
  }
  std::vector<int> order = identity(n);
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

void Cdt::link(int h, int outer, std::uint8_t kind) {
  opposite[h] = outer;
  fixed[h] = kind;
  if (outer >= 0) opposite[outer] = h;
}

int Cdt::walk(Vec2 p, int t, std::uint8_t barrier) const {
  int from = -1;
  // a visibility walk may loop in a triangulation that is not Delaunay, unless it does not
  // always try the same edge first (Devillers, Pion, Teillaud 2002); its steps are counted nevertheless
  unsigned random = 12345;
  for (std::size_t step = 0; step < tris.size() + 3; ++step) {
    random = 1664525 * random + 1013904223;
    int out = -1;
    for (int k = 0, h = 3 * t + (int)((random >> 16) % 3); k < 3 && out < 0; ++k, h = next(h))
      if (h != from && orient2d(points[origin(h)], points[target(h)], p) < 0) out = h;
    if (out < 0) return t;
    if (fixed[out] >= barrier || opposite[out] < 0) return -1;
    from = opposite[out];
    t = from / 3;
  }
  return -1;
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
}

int Cdt::half_edge(int a, int b) const {
  int found = -1;
  around(a, [&](int h) {
    if (target(h) == b) found = h;
  });
  return found;
}

int Cavity::fill(Cdt& cdt, Vec2 p) {
  int v = (int)cdt.points.size();
  cdt.points.push_back(p);
  cdt.at.push_back(-1);
  start_.resize(cdt.points.size());
  rim_data_.clear();
  for (int h : rim_) rim_data_.push_back({cdt.origin(h), cdt.target(h), cdt.opposite[h], cdt.fixed[h]});
  fan_ = cavity_;
  for (int t = (int)cdt.tris.size(); fan_.size() < rim_.size(); ++t) fan_.push_back(t);
  if (fan_.back() >= (int)cdt.tris.size()) {
    std::size_t n = fan_.back() + 1;
    cdt.tris.resize(n);
    cdt.opposite.resize(3 * n, -1);
    cdt.fixed.resize(3 * n, Cdt::free_edge);
    cdt.version.resize(n, 0);
  }
  for (std::size_t k = 0; k < fan_.size(); ++k) {
    auto [a, b, outer, kind] = rim_data_[k];
    int t = fan_[k];
    cdt.set(t, {a, b, v});
    cdt.link(3 * t, outer, (std::uint8_t)kind);
    cdt.fixed[3 * t + 1] = cdt.fixed[3 * t + 2] = Cdt::free_edge;
    start_[a] = t;
  }
  for (int t : fan_) {
    int s = start_[cdt.tris[t][1]];
    cdt.opposite[3 * t + 1] = 3 * s + 2;
    cdt.opposite[3 * s + 2] = 3 * t + 1;
  }
  return v;
}

namespace {

/// Inserts all points into a triangle far around them, whose corners get the numbers n, n + 1, n + 2.
void insert_all(Cdt& cdt) {
  const int n = (int)cdt.points.size();
  if (n < 3) throw GoalMissed("no region with " + std::to_string(n) + " points");
  Vec2 lo = cdt.points[0], hi = cdt.points[0];
  for (Vec2 p : cdt.points) lo = lower(lo, p), hi = upper(hi, p);
  double extent = std::max(hi.x - lo.x, hi.y - lo.y);
  if (!(extent > 0)) fail_at("all points are at ", lo);
  std::vector<int> order = insertion_order(cdt.points, lo, extent);
  std::vector<Vec2> input = std::move(cdt.points);
  Vec2 c = 0.5 * (lo + hi);
  cdt.points.assign(n, c);
  cdt.points.push_back(c + extent * Vec2{-20, -16});
  cdt.points.push_back(c + extent * Vec2{20, -15});
  cdt.points.push_back(c + extent * Vec2{1, 22});
  cdt.at.assign(n + 3, -1);
  cdt.tris = {{n, n + 1, n + 2}};
  cdt.opposite.assign(3, -1);
  cdt.fixed.assign(3, Cdt::free_edge);
  cdt.version.assign(1, 0);
  for (int i = 0; i < 3; ++i) cdt.at[n + i] = 0;
  int t = 0;
  Cavity cavity;
  for (int i : order) {
    Vec2 p = input[i];
    t = cdt.walk(p, t);
    bool new_point = t >= 0 && cavity.grow(cdt, p, t, [&](int s) {
      return incircle(cdt.points[cdt.tris[s][0]], cdt.points[cdt.tris[s][1]], cdt.points[cdt.tris[s][2]], p) >
             0;
    });
    if (!new_point) fail_at("two points at ", p);
    // fill appends; here the vertex has its number already
    int v = cavity.fill(cdt, p);
    cdt.points.pop_back();
    cdt.at.pop_back();
    cdt.points[i] = p;
    cdt.at[i] = cavity.fan()[0];
    for (int s : cavity.fan())
      for (int& w : cdt.tris[s])
        if (w == v) w = i;
    t = cavity.fan()[0];
  }
}

/// Makes the segment from a to b an edge.
void recover(Cdt& cdt, int a, int b, std::uint8_t kind) {
  const std::vector<Vec2>& points = cdt.points;
  auto fail = [&](const char* what, int v) {
    fail_at("the segment " + show(points[a]) + " " + show(points[b]) + " " + what + " ", points[v]);
  };
  if (a == b) fail("has no length at", a);
  int h = cdt.half_edge(a, b);
  if (h < 0) {
    // the edges that cross it, found by marching from a to b
    std::deque<std::pair<int, int>> crossing;
    int first = -1;
    cdt.around(a, [&](int e) {
      int x = orient2d(points[a], points[b], points[cdt.target(e)]);
      if (x == 0 && dot(points[cdt.target(e)] - points[a], points[b] - points[a]) > 0)
        fail("runs through", cdt.target(e));
      if (x < 0 && orient2d(points[a], points[b], points[cdt.apex(e)]) > 0) first = next(e);
    });
    for (int e = first;;) {
      if (cdt.fixed[e]) fail("crosses one at", cdt.origin(e));
      crossing.push_back({cdt.origin(e), cdt.target(e)});
      int o = cdt.opposite[e], z = cdt.apex(o);
      if (z == b) break;
      int side = orient2d(points[a], points[b], points[z]);
      if (side == 0) fail("runs through", z);
      e = side > 0 ? next(o) : prev(o);
    }
    // flip them away (Sloan 1993)
    while (!crossing.empty()) {
      auto [x, y] = crossing.front();
      crossing.pop_front();
      int e = cdt.half_edge(x, y);
      if (!cdt.can_flip(e)) {
        crossing.push_back({x, y});
        continue;
      }
      cdt.flip(e);
      e = 3 * (e / 3);
      int c = cdt.origin(e), d = cdt.target(e);
      if (c != a && c != b && d != a && d != b &&
          orient2d(points[a], points[b], points[c]) * orient2d(points[a], points[b], points[d]) < 0)
        crossing.push_back({c, d});
    }
    h = cdt.half_edge(a, b);
  }
  if (cdt.fixed[h]) fail("lies on another at", a);
  cdt.fixed[h] = cdt.fixed[cdt.opposite[h]] = kind;
}

/// Flips free edges until all are Delaunay.
void make_delaunay(Cdt& cdt) {
  std::vector<int> todo = identity(3 * cdt.tris.size());
  while (!todo.empty()) {
    int h = todo.back(), o = cdt.opposite[h];
    todo.pop_back();
    if (o < 0 || cdt.fixed[h]) continue;
    if (incircle(cdt.points[cdt.origin(h)], cdt.points[cdt.target(h)], cdt.points[cdt.apex(h)],
                 cdt.points[cdt.apex(o)]) <= 0)
      continue;
    int t = h / 3, s = o / 3;
    cdt.flip(h);
    for (int e : {3 * t + 1, 3 * t + 2, 3 * s + 1, 3 * s + 2}) todo.push_back(e);
  }
}

/// Removes the triangles outside the borders, and the n + 1st to n + 3rd vertex with them.
void carve(Cdt& cdt, int n) {
  // outside is 0; a border segment leads to the other side
  std::vector<signed char> side(cdt.tris.size(), -1);
  std::vector<int> todo{cdt.at[n]};
  side[cdt.at[n]] = 0;
  while (!todo.empty()) {
    int t = take_last(todo);
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (cdt.opposite[h] < 0) continue;
      signed char s = side[t] ^ (cdt.fixed[h] == Cdt::border_segment);
      int u = cdt.opposite[h] / 3;
      if (side[u] < 0) {
        side[u] = s;
        todo.push_back(u);
      } else if (side[u] != s) {
        fail_at("the border is not closed at ", cdt.points[cdt.origin(h)]);
      }
    }
  }
  std::vector<int> number(cdt.tris.size(), -1);
  int m = 0;
  for (std::size_t t = 0; t < cdt.tris.size(); ++t)
    if (side[t] == 1) number[t] = m++;
  if (m == 0) fail_at("no region inside the border at ", cdt.points[0]);
  std::fill(cdt.at.begin(), cdt.at.end(), -1);
  for (std::size_t t = 0; t < cdt.tris.size(); ++t) {
    int k = number[t];
    if (k < 0) continue;
    for (int i = 0; i < 3; ++i) {
      int o = cdt.opposite[3 * t + i];
      cdt.at[cdt.tris[t][i]] = k;
      cdt.opposite[3 * k + i] = o < 0 || number[o / 3] < 0 ? -1 : 3 * number[o / 3] + o % 3;
      cdt.fixed[3 * k + i] = cdt.fixed[3 * t + i];
    }
    cdt.tris[k] = cdt.tris[t];
  }
  cdt.tris.resize(m);
  cdt.opposite.resize(3 * m);
  cdt.fixed.resize(3 * m);
  cdt.version.assign(m, 0);
  cdt.points.resize(n);
  cdt.at.resize(n);
  for (int v = 0; v < n; ++v)
    if (cdt.at[v] < 0) fail_at("the point ", cdt.points[v], " lies outside the border");
}

}  // namespace

Cdt::Cdt(std::vector<Vec2> input, const std::vector<FixedEdge>& segments) : points(std::move(input)) {
  const int n = (int)points.size();
  insert_all(*this);
  for (const FixedEdge& s : segments) recover(*this, s.a, s.b, s.border ? border_segment : inner_segment);
  make_delaunay(*this);
  carve(*this, n);
}

}  // namespace meshpipe
