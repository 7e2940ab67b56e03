// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>

#include "lib/clean/repair.h"
#include "lib/core/lists.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// A triangle is flat if its height is below this part of its longest edge (rounding of the area's own
/// terms).
constexpr double flatness = 1e-12;
/// A flat triangle is a needle, and may collapse, if its shortest edge is below this part of the longest. The
/// flip, which moves nothing, comes first.
constexpr double needle = 1e-6;
/// Two flat triangles are flipped if the sum of their longest edges falls to this part: more than rounding.
constexpr double shorter = 1 - 1e-9;
/// Times that each may be flipped so: a slit of n points between fans takes n.
constexpr int most_slit_flips = 100;

class Flat {
 public:
  Flat(Repair& r, const std::vector<Vec3>& points) : r_(r), points_(points), gone_(r.tris.size(), 0) {}

  FlatCounts remove() {
    FlatCounts counts;
    std::vector<int> flat;
    std::vector<char> waits(r_.tris.size(), 0);
#pragma omp parallel for schedule(static)
    for (std::size_t t = 0; t < waits.size(); ++t) waits[t] = is_flat(r_.tris[t]);
    for (int t = 0; t < (int)waits.size(); ++t)
      if (waits[t]) flat.push_back(t);
    // What is done may free neighbors, which are tried next, or others by the edges it takes away: as long
    // as something is done, which lowers their number, all are tried again; then slits are flipped.
    std::vector<int> queue, close;
    int slits = 0;
    for (bool again = !flat.empty(); again;) {
      again = false;
      queue = flat;
      for (int t : queue) waits[t] = 1;
      for (std::size_t i = 0; i < queue.size(); ++i) {
        const int t = queue[i];
        waits[t] = 0;
        if (gone_[t] || !is_flat(r_.tris[t])) continue;
        const int face = r_.face[t];
        close.assign(1, t);
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
          const int u = r_.opposite[h] / 3;
          if (r_.opposite[h] < 0) continue;
          close.push_back(u);
          for (int g = 3 * u; g < 3 * u + 3; ++g)
            if (r_.opposite[g] >= 0) close.push_back(r_.opposite[g] / 3);
        }
        if (!(drop_on_border(t) || flip_longest(t, true) || collapse(t))) continue;
        counts.removed.push_back(face);
        again = true;
        for (int u : close)
          if (!gone_[u] && !waits[u] && is_flat(r_.tris[u])) {
            waits[u] = 1;
            queue.push_back(u);
          }
      }
      std::erase_if(flat, [&](int t) { return gone_[t] || !is_flat(r_.tris[t]); });
      if (again || ++slits > most_slit_flips) continue;
      for (int t : flat) again |= flip_longest(t, false);
    }
    drop_components(flat, counts.removed);
    counts.left = (int)flat.size();
    if (std::count(gone_.begin(), gone_.end(), 1)) drop(r_, gone_);
    return counts;
  }

 private:
  Vec3 point(int v) const { return points_[r_.vertex[v]]; }
  double length(int h) const { return norm(point(target(r_.tris, h)) - point(origin(r_.tris, h))); }

  Vec3 normal(const Tri& t) const { return area_vector(point(t[0]), point(t[1]), point(t[2])); }

  double longest(const Tri& t) const {
    const Vec3 a = point(t[0]), b = point(t[1]), c = point(t[2]);
    return std::sqrt(std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)}));
  }

  bool is_flat(const Tri& t) const { return norm(normal(t)) <= flatness * longest(t) * longest(t); }

  int longest_edge(int t) const {
    return std::max({3 * t, 3 * t + 1, 3 * t + 2}, [&](int g, int h) { return length(g) < length(h); });
  }

  void connect(int h, int o) {
    if (h >= 0) r_.opposite[h] = o;
    if (o >= 0) r_.opposite[o] = h;
  }

  /// Whether an edge joins the origins of two half-edges: visits the neighbors of both in turns, so that the
  /// one with fewer of them decides.
  bool joined(int h, int g) const {
    const int a = origin(r_.tris, h), b = origin(r_.tris, g);
    struct Walk {
      int seed, at, to;
      bool back;
    } walks[] = {{h, h, b, false}, {g, g, a, false}};
    for (;;)
      for (Walk& w : walks) {
        if (target(r_.tris, w.at) == w.to || origin(r_.tris, prev(w.at)) == w.to) return true;
        int step = w.back ? -1 : r_.opposite[prev(w.at)];
        if (step == w.seed) return false;
        if (step < 0) {  // continues from the seed in the other direction
          const int other = r_.opposite[w.back ? w.at : w.seed];
          w.back = true;
          if (other < 0) return false;
          step = next(other);
        }
        w.at = step;
      }
  }

  /// Drops those of components in which all triangles are flat.
  void drop_components(std::vector<int>& flat, std::vector<int>& removed) {
    if (flat.empty()) return;
    for (std::size_t h = 0; h < r_.opposite.size(); ++h)
      if (gone_[h / 3]) r_.opposite[h] = -1;
    std::vector<int> component;
    std::vector<char> has_area(components(r_.opposite, component), 0);
    for (int t = 0; t < (int)r_.tris.size(); ++t)
      if (!gone_[t] && !is_flat(r_.tris[t])) has_area[component[t]] = 1;
    for (int t : flat)
      if (!has_area[component[t]]) removed.push_back(r_.face[t]), gone_[t] = 1;
    std::erase_if(flat, [&](int t) { return gone_[t]; });
  }

  bool drop_on_border(int t) {
    const int h = longest_edge(t), a = r_.opposite[next(h)], b = r_.opposite[prev(h)];
    if (r_.opposite[h] >= 0) return false;
    if (a >= 0 && b >= 0 && !for_each_spoke(r_.opposite, prev(h), [](int) {}))
      return false;  // would pinch it
    connect(-1, a);
    connect(-1, b);
    gone_[t] = 1;
    return true;
  }

  //      c            c          the edge a-b of the flat triangle t becomes c-d;
  //   t / \          /|\         both triangles now are pieces of u, and take its
  //    a---b   ->   a | b        columns. `fewer`: only if fewer are flat then; else only if two are that
  //   u \ /          \|/         stay flat, of a slit between points in line, and their edges get shorter
  //      d            d
  bool flip_longest(int t, bool fewer) {
    const int h = longest_edge(t), o = r_.opposite[h];
    if (o < 0) return false;
    const int u = o / 3;
    const int a = origin(r_.tris, h), b = target(r_.tris, h), c = origin(r_.tris, prev(h)),
              d = origin(r_.tris, prev(o));
    if (c == d || joined(prev(h), prev(o))) return false;
    const Tri left{a, d, c}, right{d, b, c};
    const int before = 1 + is_flat(r_.tris[u]), after = is_flat(left) + is_flat(right);
    if (fewer ? before <= after
              : before + after < 4 ||
                    !(longest(left) + longest(right) < shorter * (longest(r_.tris[t]) + longest(r_.tris[u]))))
      return false;
    const int bc = r_.opposite[next(h)], ca = r_.opposite[prev(h)], ad = r_.opposite[next(o)],
              db = r_.opposite[prev(o)];
    r_.tris[t] = left;
    r_.tris[u] = right;
    r_.face[t] = r_.face[u];
    r_.flipped[t] = r_.flipped[u];
    connect(3 * t, ad);
    connect(3 * t + 1, 3 * u + 2);
    connect(3 * t + 2, ca);
    connect(3 * u, db);
    connect(3 * u + 1, bc);
    return true;
  }

  //    d             d      the shortest edge a-b of the needle t goes, and the triangle u on its other
  //   / \            |      side; what b was joined to is joined to a
  //  a---b    ->     a
  //   \ /            |
  //    c             c
  bool collapse(int t) {
    const int h =
        std::min({3 * t, 3 * t + 1, 3 * t + 2}, [&](int f, int g) { return length(f) < length(g); });
    if (length(h) > needle * length(longest_edge(t))) return false;
    const int o = r_.opposite[h];
    auto link = [&](int spoke, std::vector<int>& vertices) {
      const bool inside = for_each_spoke(r_.opposite, spoke, [&](int g) {
        vertices.push_back(target(r_.tris, g));
        vertices.push_back(origin(r_.tris, prev(g)));
      });
      sort_unique(vertices);
      return inside;
    };
    std::vector<int> link_a, link_b, common;
    const bool a_inside = link(h, link_a), b_inside = link(next(h), link_b);
    if (o >= 0 && !a_inside && !b_inside) return false;  // would pinch it
    std::set_intersection(link_a.begin(), link_a.end(), link_b.begin(), link_b.end(),
                          std::back_inserter(common));
    if (common.size() != (o >= 0 ? 2u : 1u)) return false;  // would double an edge
    const int bc = r_.opposite[next(h)], ca = r_.opposite[prev(h)];
    if (bc >= 0 && ca >= 0 && origin(r_.tris, prev(bc)) == origin(r_.tris, prev(ca)))
      return false;  // a tetrahedron

    const bool keep_a = b_inside || !a_inside;  // a vertex of the border stays there
    const int kept = origin(r_.tris, keep_a ? h : next(h)), goes = keep_a ? next(h) : h;
    bool turns = false;
    std::vector<int> spokes;
    for_each_spoke(r_.opposite, goes, [&](int g) {
      spokes.push_back(g);
      if (g / 3 == t || (o >= 0 && g / 3 == o / 3)) return;
      const Tri& old = r_.tris[g / 3];
      Tri moved = old;
      moved[g % 3] = kept;
      turns = turns || (!is_flat(old) && (is_flat(moved) || dot(normal(old), normal(moved)) <= 0));
    });
    if (turns) return false;
    for (int g : spokes) r_.tris[g / 3][g % 3] = kept;
    for (int side : {h, o}) {
      if (side < 0) continue;
      connect(r_.opposite[next(side)], r_.opposite[prev(side)]);
      gone_[side / 3] = 1;
    }
    return true;
  }

  Repair& r_;
  const std::vector<Vec3>& points_;
  std::vector<char> gone_;
};

}  // namespace

FlatCounts remove_flat(Repair& r, const std::vector<Vec3>& points) { return Flat(r, points).remove(); }

}  // namespace meshpipe
