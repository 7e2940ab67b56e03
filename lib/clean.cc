// SPDX-License-Identifier: BSD-3-Clause
#include "lib/clean.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "lib/edges.h"
#include "lib/error.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

std::uint64_t mix(std::uint64_t x) {  // a bijection that spreads every bit (multiply and fold, twice)
  x = (x ^ x >> 32) * 0x9E3779B97F4A7C15u;
  x = (x ^ x >> 29) * 0xD6E8FEB86659FD93u;
  return x ^ x >> 32;
}

/// same[v] is the first vertex of `used` with the coordinates of v.
std::vector<int> weld(const std::vector<Vec3>& points, const std::vector<char>& used) {
  const std::size_t mask = std::bit_ceil(2 * points.size() + 2) - 1;
  std::vector<int> slot(mask + 1, -1), same(points.size());
  auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 + 0 is 0
  for (int v = 0; v < (int)points.size(); ++v) {
    same[v] = v;
    if (!used[v]) continue;
    const Vec3 p = points[v];
    std::size_t i = mix(bits(p.x) + mix(bits(p.y) + mix(bits(p.z)))) & mask;
    while (slot[i] >= 0 && !(points[slot[i]] == p)) i = (i + 1) & mask;
    if (slot[i] < 0) slot[i] = v;
    same[v] = slot[i];
  }
  return same;
}

/// Rows of a table in another order; rows may be left out or repeated.
void take_rows(Table& table, const std::vector<int>& rows) {
  for (Column& c : table.columns)
    std::visit(
        [&](auto& old) {
          std::remove_reference_t<decltype(old)> values(rows.size());
          for (std::size_t i = 0; i < rows.size(); ++i) values[i] = old[rows[i]];
          old = std::move(values);
        },
        c.data);
  table.rows = rows.size();
}

/// The surface while it is repaired: where each triangle and vertex came from, and neighbours across edges of
/// two triangles.
struct Repair {
  std::vector<Tri> tris;
  std::vector<int> face;      ///< triangle of the input
  std::vector<int> vertex;    ///< vertex of the input
  std::vector<int> opposite;  ///< half-edges; may run the same way until `orient`
  std::vector<char> split;    ///< vertices of non-manifold edges
  std::vector<char> flipped;  ///< triangles turned round
};

void drop(Repair& r, const std::vector<char>& gone) {
  std::size_t n = 0;
  for (std::size_t t = 0; t < r.tris.size(); ++t)
    if (!gone[t]) {
      r.tris[n] = r.tris[t];
      r.face[n++] = r.face[t];
    }
  r.tris.resize(n);
  r.face.resize(n);
}

/// Finds the neighbours, and the duplicates: of the triangles on an edge, those with the same third vertex as
/// an earlier one.
void join(Repair& r, CleanReport& report) {
  const int n = (int)r.vertex.size();
  std::vector<char> gone(r.tris.size(), 0);
  std::vector<EdgeUse> third;
  for (bool again = true; again;) {
    again = false;
    report.nonmanifold_edges = 0;
    r.split.assign(n, 0);
    r.opposite.assign(3 * r.tris.size(), -1);
    for_each_edge(r.tris, n, [&](std::span<const EdgeUse> uses) {
      if (uses.size() < 2) return;
      third.clear();
      for (EdgeUse e : uses)
        third.push_back((EdgeUse)origin(r.tris, prev(half_edge(e))) << 32 | (std::uint32_t)half_edge(e));
      std::sort(third.begin(), third.end());
      for (std::size_t i = 1; i < third.size(); ++i)
        if (third[i] >> 32 == third[i - 1] >> 32) {
          gone[half_edge(third[i]) / 3] = 1;
          again = true;
        }
      const int h = half_edge(uses[0]), g = half_edge(uses[1]);
      if (uses.size() > 2) {
        ++report.nonmanifold_edges;
        r.split[origin(r.tris, h)] = r.split[target(r.tris, h)] = 1;
      } else {
        r.opposite[h] = g;
        r.opposite[g] = h;
      }
    });
    if (again) {
      report.duplicate = (int)std::count(gone.begin(), gone.end(), 1);
      drop(r, gone);
      gone.assign(r.tris.size(), 0);
    }
  }
}

/// Turns a triangle round: its half-edges 0 1 2 become 2 1 0.
void turn(Repair& r, int t) {
  std::swap(r.tris[t][1], r.tris[t][2]);
  std::swap(r.opposite[3 * t], r.opposite[3 * t + 2]);
  for (int h : {3 * t, 3 * t + 2})
    if (r.opposite[h] >= 0) r.opposite[r.opposite[h]] = h;
  r.flipped[t] ^= 1;
}

/// Makes neighbours agree: a flood from the first triangle of each component, turned to the side of its
/// majority.
void orient(Repair& r) {
  const int n = (int)r.tris.size();
  enum : char { unseen, as_seed, against };
  std::vector<char> side(n, unseen);
  std::vector<int> members;
  for (int seed = 0; seed < n; ++seed) {
    if (side[seed] != unseen) continue;
    side[seed] = as_seed;
    members.assign(1, seed);
    std::size_t turned = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const int t = members[i];
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = r.opposite[h];
        if (o < 0) continue;
        const bool agree = origin(r.tris, h) != origin(r.tris, o);
        const char want = agree == (side[t] == as_seed) ? as_seed : against;
        if (side[o / 3] == unseen) {
          side[o / 3] = want;
          turned += want == against;
          members.push_back(o / 3);
        } else if (side[o / 3] != want) {
          throw NotAdmissible("the component of triangle " + std::to_string(r.face[seed]) +
                              " is not orientable: triangles " + std::to_string(r.face[t]) + " and " +
                              std::to_string(r.face[o / 3]) + " cannot agree");
        }
      }
    }
    const char wrong = 2 * turned > members.size() ? as_seed : against;
    for (int t : members)
      if (side[t] == wrong) turn(r, t);
  }
}

/// Gives every fan of triangles round a vertex its own copy of the vertex, the first fan keeps it. Triangles
/// of an edge that was left open and still share both its vertices lie in one fan at either end (a fan has
/// two ends), in opposite directions, so what results is an oriented manifold.
void split_fans(Repair& r, CleanReport& report) {
  const int n = (int)r.vertex.size();
  std::vector<char> seen(r.opposite.size(), 0);
  enum : char { none, one, many };
  std::vector<char> fans(n, none);
  std::vector<int> fan;
  for (int seed = 0; seed < (int)r.opposite.size(); ++seed) {
    if (seen[seed]) continue;
    fan.clear();
    int h = seed;
    do {
      fan.push_back(h);
      h = r.opposite[prev(h)];
    } while (h >= 0 && h != seed);
    if (h < 0)
      for (h = r.opposite[seed]; h >= 0; h = r.opposite[h]) fan.push_back(h = next(h));
    for (int g : fan) seen[g] = 1;
    const int v = origin(r.tris, seed);
    if (fans[v] != none) {
      if (fans[v] == one && !r.split[v]) ++report.pinched;
      for (int g : fan) r.tris[g / 3][g % 3] = (int)r.vertex.size();
      r.vertex.push_back(r.vertex[v]);
    }
    fans[v] = fans[v] == none ? one : many;
  }
}

/// Turns closed components inside out whose signed volume is clearly negative.
void face_outward(Repair& r, const std::vector<Vec3>& points) {
  std::vector<int> component;
  const int n = components(r.opposite, component);
  std::vector<char> closed(n, 1);
  std::vector<int> seed(n, -1);
  std::vector<double> volume(n, 0), area(n, 0);
  for (int t = 0; t < (int)r.tris.size(); ++t) {
    const int c = component[t];
    if (seed[c] < 0) seed[c] = r.tris[t][0];
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (r.opposite[h] < 0) closed[c] = 0;
    const Vec3 o = points[r.vertex[seed[c]]];  // near, for the digits
    const Vec3 a = points[r.vertex[r.tris[t][0]]] - o, b = points[r.vertex[r.tris[t][1]]] - o,
               d = points[r.vertex[r.tris[t][2]]] - o;
    volume[c] += dot(a, cross(b, d)) / 6;
    area[c] += 0.5 * norm(area_vector(a, b, d));
  }
  for (int t = 0; t < (int)r.tris.size(); ++t) {
    const int c = component[t];
    if (closed[c] && volume[c] < -1e-12 * area[c] * std::sqrt(area[c])) turn(r, t);
  }
}

/// Triangles without height: a flat triangle is a cap on its longest edge, which is flipped, so that the
/// neighbour is split where the cap's third vertex lies on it; on the border the cap is dropped. The surface
/// stays the same set of points.
class Flatness {
 public:
  Flatness(Repair& r, const std::vector<Vec3>& points) : r_(r), points_(points), gone_(r.tris.size(), 0) {}

  void remove(CleanReport& report) {
    std::vector<int> flat;
    for (int t = 0; t < (int)r_.tris.size(); ++t)
      if (is_flat(r_.tris[t])) flat.push_back(t);
    for (bool again = !flat.empty();
         again;) {  // a flip may free its neighbour; every round lowers their number
      again = false;
      std::vector<int> left;
      for (int t : flat) {
        if (gone_[t] || !is_flat(r_.tris[t])) continue;
        if (drop_on_border(t) || flip(t)) {
          ++report.degenerate;
          again = true;
        }
        if (!gone_[t] && is_flat(r_.tris[t])) left.push_back(t);
      }
      flat = std::move(left);
    }
    report.flat = (int)flat.size();
    if (std::count(gone_.begin(), gone_.end(), 1) == 0) return;
    drop(r_, gone_);
    r_.opposite.clear();  // of no use any more
  }

 private:
  Vec3 point(int v) const { return points_[r_.vertex[v]]; }

  bool is_flat(const Tri& t) const {
    const Vec3 a = point(t[0]), b = point(t[1]), c = point(t[2]);
    const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    return norm(area_vector(a, b, c)) <= 1e-12 * longest;
  }

  int longest_edge(int t) const {
    int best = 3 * t;
    double length = -1;
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (double l = norm(point(target(r_.tris, h)) - point(origin(r_.tris, h))); l > length) {
        length = l;
        best = h;
      }
    return best;
  }

  /// Calls visit(w) for the vertices joined to the origin of h; returns whether it is inside the surface.
  template <class Visit>
  bool around(int h, Visit visit) const {
    const int seed = h;
    do {
      visit(target(r_.tris, h));
      visit(origin(r_.tris, prev(h)));
      h = r_.opposite[prev(h)];
    } while (h >= 0 && h != seed);
    if (h == seed) return true;
    for (h = r_.opposite[seed]; h >= 0; h = r_.opposite[h]) {
      h = next(h);
      visit(target(r_.tris, h));
    }
    return false;
  }

  void connect(int h, int o) {
    r_.opposite[h] = o;
    if (o >= 0) r_.opposite[o] = h;
  }

  bool drop_on_border(int t) {
    const int h = longest_edge(t), a = r_.opposite[next(h)], b = r_.opposite[prev(h)];
    if (r_.opposite[h] >= 0) return false;
    if (a >= 0 && b >= 0 && !around(prev(h), [](int) {})) return false;  // would pinch it
    for (int o : {a, b})
      if (o >= 0) r_.opposite[o] = -1;
    gone_[t] = 1;
    return true;
  }

  //      c            c          the edge a-b of the flat triangle t becomes c-d;
  //   t / \          /|\         both triangles now are pieces of u, and take its
  //    a---b   ->   a | b        columns
  //   u \ /          \|/
  //      d            d
  bool flip(int t) {
    const int h = longest_edge(t), o = r_.opposite[h];
    if (o < 0) return false;
    const int u = o / 3;
    const int a = origin(r_.tris, h), b = target(r_.tris, h), c = origin(r_.tris, prev(h)),
              d = origin(r_.tris, prev(o));
    bool joined = c == d;
    around(prev(h), [&](int w) { joined = joined || w == d; });
    if (joined) return false;
    const Tri left{a, d, c}, right{d, b, c};
    if (1 + is_flat(r_.tris[u]) <= is_flat(left) + is_flat(right)) return false;
    const int bc = r_.opposite[next(h)], ca = r_.opposite[prev(h)], ad = r_.opposite[next(o)],
              db = r_.opposite[prev(o)];
    r_.tris[t] = left;
    r_.tris[u] = right;
    r_.face[t] = r_.face[u];
    connect(3 * t, ad);
    connect(3 * t + 1, 3 * u + 2);
    connect(3 * t + 2, ca);
    connect(3 * u, db);
    connect(3 * u + 1, bc);
    return true;
  }

  Repair& r_;
  const std::vector<Vec3>& points_;
  std::vector<char> gone_;
};

/// Leaves out vertices that no triangle uses, and numbers the others by first use.
void number_by_first_use(Repair& r) {
  std::vector<int> number(r.vertex.size(), -1), vertex;
  for (Tri& t : r.tris)
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = (int)vertex.size();
        vertex.push_back(r.vertex[v]);
      }
      v = number[v];
    }
  r.vertex = std::move(vertex);
}

/// Whether the repairs undid each other: copies of vertices were welded and split again, and the triangles
/// are as they were.
bool as_it_was(const Repair& r, const Surface& surface) {
  if (r.tris.size() != surface.tris.size()) return false;
  std::vector<int> now(surface.points.size(), -1), before(r.vertex.size(), -1);
  for (std::size_t t = 0; t < r.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int v = surface.tris[t][i], w = r.tris[t][i];
      if (now[v] < 0) now[v] = w;
      if (before[w] < 0) before[w] = v;
      if (now[v] != w || before[w] != v) return false;
    }
  return std::find(now.begin(), now.end(), -1) == now.end();
}

}  // namespace

CleanReport clean(Surface& surface) {
  CleanReport report;
  const int n = (int)surface.points.size();
  report.input_vertices = n;
  report.input_triangles = (int)surface.tris.size();

  std::vector<char> used(n, 0);
  for (const Tri& t : surface.tris)
    for (int v : t) used[v] = 1;
  const std::vector<int> same = weld(surface.points, used);
  for (int v = 0; v < n; ++v) report.welded += same[v] != v;

  Repair r;
  r.vertex.resize(n);
  std::iota(r.vertex.begin(), r.vertex.end(), 0);
  r.tris.reserve(surface.tris.size());
  r.face.reserve(surface.tris.size());
  used.assign(n, 0);
  for (int t = 0; t < (int)surface.tris.size(); ++t) {
    const Tri s = surface.tris[t], w{same[s[0]], same[s[1]], same[s[2]]};
    if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) {
      ++report.degenerate;
      continue;
    }
    r.tris.push_back(w);
    r.face.push_back(t);
    for (int v : w) used[v] = 1;
  }
  for (int v = 0; v < n; ++v) report.unreferenced += same[v] == v && !used[v];

  join(r, report);
  r.flipped.assign(r.tris.size(), 0);
  orient(r);
  split_fans(r, report);
  if (report.nonmanifold_edges) r.opposite = opposite_halfedges(r.tris, (int)r.vertex.size());
  face_outward(r, surface.points);
  report.flipped = (int)std::count(r.flipped.begin(), r.flipped.end(), 1);
  Flatness(r, surface.points).remove(report);
  if (r.tris.empty())
    throw NotAdmissible("no triangle is left of " + std::to_string(report.input_triangles) + ": " +
                        std::to_string(report.degenerate) + " are degenerate");
  if (report.nothing()) return report;
  if (as_it_was(r, surface)) {
    CleanReport none;
    none.input_vertices = n;
    none.input_triangles = report.input_triangles;
    none.flat = report.flat;
    return none;
  }

  if (report.welded || report.unreferenced || report.degenerate) number_by_first_use(r);
  std::vector<Vec3> points(r.vertex.size());
  for (std::size_t v = 0; v < points.size(); ++v) points[v] = surface.points[r.vertex[v]];
  surface.points = std::move(points);
  surface.tris = std::move(r.tris);
  surface.face.erase("model");
  take_rows(surface.vertex, r.vertex);
  take_rows(surface.face, r.face);
  return report;
}

}  // namespace meshpipe
