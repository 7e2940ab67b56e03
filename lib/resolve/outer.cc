// SPDX-License-Identifier: BSD-3-Clause
#include "lib/resolve/outer.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "lib/core/around.h"
#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"
#include "lib/core/edges.h"
#include "lib/core/lists.h"
#include "lib/core/ray.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

/// The sides of pieces, as numbered in lib/core/around.h. Sides of one region that are connected along edges
/// form a shell; if only edges count that close, a level: all of it has one winding number.
struct Sides {
  UnionFind shell, level, component;
  std::vector<char> open;  ///< per piece: it has an edge that does not close
};

Sides connect_sides(const Pieces& pieces, const std::vector<Tri>& tris, const ExactPoints& points) {
  const int n = (int)pieces.tris.size();
  Sides s{UnionFind(2 * (std::size_t)n), UnionFind(2 * (std::size_t)n), UnionFind(n),
          std::vector<char>(n, 0)};
  const Around around(pieces.tris, [&](int t, int v) { return points.side(tris[pieces.origin[t]], v); });
  std::vector<int> edge;
  for_each_edge(pieces.tris, points.size(), [&](std::span<const EdgeUse> uses) {
    edge.clear();
    int sum = 0;
    for (EdgeUse e : uses) {
      const int h = half_edge(e);
      edge.push_back(h);
      sum += around.forward(h) ? pieces.weight[h / 3] : -pieces.weight[h / 3];
      s.component.join(h / 3, edge[0] / 3);
    }
    if (sum != 0) s.open[edge[0] / 3] = 1;
    if (edge.size() > 2) around.sort(edge);
    for (std::size_t i = 0; i < edge.size(); ++i) {
      const int a = around.side(edge[i]), b = around.side(edge[(i + 1) % edge.size()], true);
      s.shell.join(a, b);
      if (sum == 0) s.level.join(a, b);
    }
  });
  return s;
}

/// Per component: the winding number of all others that are closed, in the middle of its largest piece.
std::vector<int> surrounding(const Mesh& mesh, const std::vector<int>& weight, const Pieces& pieces,
                             const ExactPoints& points, const Hull& hull,
                             const std::vector<signed char>& sign) {
  const std::vector<char>& open = hull.open;
  std::vector<int> sum(open.size(), 0);
  if (open.size() < 2) return sum;
  std::vector<Vec3> place(open.size());
  std::vector<double> largest(open.size(), -1);
  for (std::size_t t = 0; t < pieces.tris.size(); ++t) {
    const auto [a, b, c] = pieces.tris[t];
    const Vec3 p = points.near(a), q = points.near(b), r = points.near(c);
    const int k = hull.component[t];
    if (const double area = norm(area_vector(p, q, r)); area > largest[k])
      largest[k] = area, place[k] = (1.0 / 3) * (p + q + r);
  }
  const Bvh tree(mesh);
  double end = -infinity;
  for (const Tri& t : mesh.tris)
    for (int v : t) end = std::max(end, mesh.points[v].x);
  for (int c = 0; c < (int)sum.size(); ++c) {
    const Vec3 p = place[c];
    tree.overlapping({p, {end, p.y, p.z}}, [&](int t) {
      const int d = hull.component[pieces.piece_of[t]];
      if (d == c || open[d]) return;
      const Tri& v = mesh.tris[t];
      sum[c] +=
          sign[d] * weight[t] * ray_crossing(p, mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]);
    });
  }
  return sum;
}

/// The signed volume of each component, six times.
std::vector<double> volumes(const Pieces& pieces, const ExactPoints& points, const Hull& hull) {
  std::vector<int> seed(hull.open.size(), -1);
  std::vector<double> sum(hull.open.size(), 0);
  for (std::size_t t = 0; t < pieces.tris.size(); ++t) {
    const auto [a, b, c] = pieces.tris[t];
    int& o = seed[hull.component[t]];
    if (o < 0) o = a;
    const Vec3 p = points.near(o);
    sum[hull.component[t]] +=
        pieces.weight[t] * dot(points.near(a) - p, cross(points.near(b) - p, points.near(c) - p));
  }
  return sum;
}

/// The number of bodies of the input, by its vertices, whose volume is negative in a closed component of
/// several bodies. `sign`: by component.
int count_subtracted(const Mesh& mesh, const std::vector<int>& weight, const Pieces& pieces, const Hull& hull,
                     const std::vector<signed char>& sign) {
  UnionFind bodies(mesh.points.size());
  for (const auto& [a, b, c] : mesh.tris) bodies.join(a, b), bodies.join(a, c);
  std::vector<double> volume(mesh.points.size(), 0);
  std::vector<int> component(mesh.points.size(), -1), of_component(hull.open.size(), 0);
  for (int t = 0; t < (int)mesh.tris.size(); ++t) {
    const int b = bodies.find(mesh.tris[t][0]), c = hull.component[pieces.piece_of[t]];
    if (component[b] < 0) ++of_component[c];
    component[b] = c;
    volume[b] += sign[c] * weight[t] * volume6(mesh, t, mesh.points[b]);
  }
  int n = 0;
  for (std::size_t b = 0; b < volume.size(); ++b)
    if (const int c = component[b]; c >= 0) n += !hull.open[c] && of_component[c] > 1 && volume[b] < 0;
  return n;
}

/// The shell of each component that bounds it from outside: its volume, by the orientation away from the
/// region, is the negative sum of the others'.
std::vector<int> outer_shells(const Pieces& pieces, const ExactPoints& points, Sides& sides,
                              const Hull& hull) {
  const int n = (int)pieces.tris.size();
  std::vector<int> seed(hull.open.size(), -1), outer(hull.open.size(), -1);
  std::vector<double> volume(2 * (std::size_t)n, 0);
  for (int t = 0; t < n; ++t) {
    const auto [a, b, c] = pieces.tris[t];
    int& o = seed[hull.component[t]];
    if (o < 0) o = a;
    const Vec3 p = points.near(o);
    const double v = dot(points.near(a) - p, cross(points.near(b) - p, points.near(c) - p));
    volume[sides.shell.find(2 * t)] -= v;
    volume[sides.shell.find(2 * t + 1)] += v;
  }
  for (int t = 0; t < n; ++t)
    for (int side : {2 * t, 2 * t + 1}) {
      const int s = sides.shell.find(side);
      int& least = outer[hull.component[t]];
      if (least < 0 || volume[s] < volume[least]) least = s;
    }
  return outer;
}

constexpr int unknown = std::numeric_limits<int>::max();

/// Winding numbers, which go from level to level through the pieces.
class Winding {
 public:
  Winding(const Pieces& pieces, Sides& sides)
      : pieces_(pieces), sides_(sides), number_(2 * pieces.tris.size(), unknown) {
    for_each_level(pieces, sides);
  }
  int at(int side) const { return number_[sides_.level.find(side)]; }
  /// Gives the level of a side a number, and all that are connected with it. Returns whether they agree.
  bool spread(int side, int number);

 private:
  void for_each_level(const Pieces& pieces, Sides& sides);
  const Pieces& pieces_;
  Sides& sides_;
  std::vector<int> number_;        ///< by the side that names the level
  std::vector<int> first_, next_;  ///< the sides of a level: by its name, and by side
};

void Winding::for_each_level(const Pieces& pieces, Sides& sides) {
  const int n = 2 * (int)pieces.tris.size();
  first_.assign(n, -1);
  next_.assign(n, -1);
  for (int side = n - 1; side >= 0; --side) next_[side] = std::exchange(first_[sides.level.find(side)], side);
}

bool Winding::spread(int side, int number) {
  bool agree = true;
  std::vector<int> todo{sides_.level.find(side)};
  number_[todo[0]] = number;
  while (!todo.empty()) {
    const int level = take_last(todo);
    for (int s = first_[level]; s >= 0; s = next_[s]) {
      const int other = sides_.level.find(s ^ 1), weight = pieces_.weight[s / 2];
      const int there = number_[level] + (s % 2 ? -weight : weight);
      if (number_[other] == unknown) {
        number_[other] = there;
        todo.push_back(other);
      }
      agree = agree && number_[other] == there;
    }
  }
  return agree;
}

/// Numbers the components.
void number_components(const Pieces& pieces, Sides& sides, Hull& hull) {
  const int n = (int)pieces.tris.size();
  std::vector<int> number(n, -1);
  for (int t = 0; t < n; ++t) {
    int& c = number[sides.component.find(t)];
    if (c < 0) c = (int)hull.open.size(), hull.open.push_back(0);
    hull.component[t] = c;
    if (sides.open[t]) hull.open[c] = 1;
  }
}

/// Twice the area of each piece.
std::vector<double> areas(const Pieces& pieces, const ExactPoints& points) {
  std::vector<double> area;
  for (const auto& [a, b, c] : pieces.tris)
    area.push_back(norm(area_vector(points.near(a), points.near(b), points.near(c))));
  return area;
}

/// Flags open components of which most bounds a region: what they enclose is solid.
std::vector<char> enclosing(const Pieces& pieces, const std::vector<double>& area, Sides& sides,
                            const std::vector<int>& outer, const Hull& hull) {
  constexpr double most = 2;  // times the area with the outside on both sides; fins are less
  std::vector<double> more(hull.open.size(), 0);
  for (int t = 0; t < (int)pieces.tris.size(); ++t) {
    const int o = outer[hull.component[t]];
    const int outside = (sides.shell.find(2 * t) == o) + (sides.shell.find(2 * t + 1) == o);
    if (outside) more[hull.component[t]] += outside == 1 ? area[t] : -most * area[t];
  }
  std::vector<char> flags(more.size());
  for (std::size_t c = 0; c < more.size(); ++c) flags[c] = hull.open[c] && more[c] > 0;
  return flags;
}

}  // namespace

Hull outer_hull(Pieces& pieces, const std::vector<Tri>& tris, const std::vector<int>& weight,
                const ExactPoints& points) {
  const int n = (int)pieces.tris.size();
  Sides sides = connect_sides(pieces, tris, points);
  Hull hull{std::vector<signed char>(n, 0), std::vector<int>(n), {}, {}};
  number_components(pieces, sides, hull);
  hull.ambiguous.assign(hull.open.size(), 0);
  Mesh mesh{{}, tris};
  for (int p = 0; p < points.size() && points.is_vertex(p); ++p) mesh.points.push_back(points.near(p));
  const std::vector<double> volume = volumes(pieces, points, hull);
  std::vector<signed char> sign(hull.open.size(), 1);
  std::vector<int> around;
  for (int pass = 1; pass <= 3; ++pass) {  // one more where what is reversed encloses others
    around = surrounding(mesh, weight, pieces, points, hull, sign);
    bool reversed = false;
    for (std::size_t c = 0; c < sign.size(); ++c)
      if (!hull.open[c] && (around[c] < 0 || (around[c] == 0 && sign[c] * volume[c] < 0)))
        sign[c] = -sign[c], reversed = true;
    if (!reversed) break;
  }
  hull.subtracted = count_subtracted(mesh, weight, pieces, hull, sign);
  const std::vector<int> outer = outer_shells(pieces, points, sides, hull);
  for (int t = 0; t < n; ++t) pieces.weight[t] *= sign[hull.component[t]];
  Winding winding(pieces, sides);
  for (std::size_t c = 0; c < outer.size(); ++c)
    if (!hull.open[c] && !winding.spread(outer[c], around[c])) hull.open[c] = 1;
  const std::vector<double> area = areas(pieces, points);
  // sheets have no outside: it is in front of the level with most area, first, and of what is not connected
  std::vector<double> front(2 * (std::size_t)n, 0);
  std::vector<int> order;
  for (int t = 0; t < n; ++t)
    if (hull.open[hull.component[t]] && pieces.weight[t] != 0) {
      const int side = sides.level.find(pieces.weight[t] > 0 ? 2 * t : 2 * t + 1);
      if (front[side] == 0) order.push_back(side);
      front[side] += area[t];
    }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return front[a] > front[b]; });
  std::vector<char> seen(hull.open.size(), 0);
  for (int side : order)
    if (const int c = hull.component[side / 2]; winding.at(side) == unknown)
      if (!winding.spread(side, around[c]) || std::exchange(seen[c], 1)) hull.ambiguous[c] = 1;
  const std::vector<char> solid = enclosing(pieces, area, sides, outer, hull);
  for (int t = 0; t < n; ++t) {
    const int c = hull.component[t];
    auto inside = [&](int side) {
      if (hull.ambiguous[c]) return around[c] > 0 || sides.shell.find(side) != outer[c];
      return winding.at(side) > 0;
    };
    const bool all = hull.ambiguous[c] && !solid[c];
    hull.keep[t] = all ? pieces.weight[t] != 0 : inside(2 * t + 1) - inside(2 * t);
  }
  for (std::size_t c = 0; c < solid.size(); ++c) hull.ambiguous[c] = hull.ambiguous[c] && !solid[c];
  return hull;
}

}  // namespace meshpipe
