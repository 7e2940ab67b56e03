// SPDX-License-Identifier: BSD-3-Clause
// Edges that one side of a slit divides and the other does not.
#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <tuple>

#include "lib/clean/repair.h"
#include "lib/core/bvh.h"
#include "lib/core/edges.h"
#include "lib/core/lists.h"
#include "lib/core/segments.h"
#include "lib/core/take_rows.h"

namespace meshpipe {
namespace {

/// Height of a triangle, and length of a side, in widths of a slit, below which it is not seen whether there
/// is a slit or a ribbon, or a small hole.
constexpr double least_height = 10;

/// A vertex that the other side of a slit has on half-edge h, at a share of its length.
struct OnEdge {
  int h;
  double at;
  int vertex;
  bool operator<(const OnEdge& o) const { return std::tie(h, at, vertex) < std::tie(o.h, o.at, o.vertex); }
};

/// A triangle, and the vertices to be put on each of its edges, in order.
struct Divided {
  Tri corner;
  std::array<std::vector<int>, 3> on;
};

/// The half-edges without a neighbor, by their vertices.
std::vector<int> lone_edges(const Repair& r) {
  std::vector<int> open = border_half_edges(r);
  auto use = [&](int h) { return std::minmax({origin(r.tris, h), target(r.tris, h)}); };
  std::sort(open.begin(), open.end(), [&](int g, int h) { return use(g) < use(h); });
  if (r.opposite.empty())
    for_each_edge(r.tris, (int)r.vertex.size(), [&](std::span<const EdgeUse> uses) {
      if (uses.size() == 1) open.push_back(half_edge(uses[0]));
    });
  return open;
}

class Slits {
 public:
  Slits(const Repair& r, const std::vector<Vec3>& points, double width)
      : r_(r), width_(width), edges_{rearranged(points, r.vertex), {}} {
    for (int h : lone_edges(r)) {
      if (!(height(h) >= least_height * width)) continue;
      open_.push_back(h);
      edges_.tris.push_back({origin(r.tris, h), target(r.tris, h), target(r.tris, h)});
    }
    ends_ = lists_of((int)r.vertex.size(), [&](auto use) {
      for (int h : open_)
        use(origin(r.tris, h), target(r.tris, h)), use(target(r.tris, h), origin(r.tris, h));
    });
  }

  /// All vertices of one side that lie within edges of the other, sorted.
  std::vector<OnEdge> find() const {
    std::vector<OnEdge> found;
    if (open_.empty()) return found;
    const Bvh tree(edges_);
    const Vec3 reach{width_, width_, width_};
    for (int v = 0; v < (int)edges_.points.size(); ++v) {
      if (ends_[v].empty()) continue;
      tree.overlapping({point(v) - reach, point(v) + reach}, [&](int e) {
        if (const double at = place_on(e, v); at > 0) found.push_back({open_[e], at, v});
      });
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  // Pairs of vertices on both sides of the end of a slit, no farther apart than it is wide:
  //   a-----------w
  //  (b)                neighbors on the border, or neighbors of the same vertex (b)
  //   c-----------u
  // Merged, they close it there. Each vertex is in one pair.
  std::vector<std::array<int, 2>> find_ends() const {
    std::vector<std::array<int, 2>> found;
    std::vector<char> used(edges_.points.size(), 0);
    auto other = [&](int v, int w) { return ends_[v].size() != 2 ? -1 : ends_[v][ends_[v][0] == w]; };
    auto add = [&](int a, int to_c, int c, int to_a) {
      if (a == c || used[a] || used[c] || !(norm(point(a) - point(c)) <= width_)) return;
      const int w = other(a, to_c), u = other(c, to_a);
      if (std::min(w, u) < 0) return;
      const Vec3 side = point(w) - point(a), across = point(u) - point(c);
      if (!(std::min(norm(side), norm(across)) >= least_height * width_ && dot(side, across) > 0)) return;
      used[a] = used[c] = 1;
      found.push_back({std::min(a, c), std::max(a, c)});
    };
    for (const Tri& e : edges_.tris) add(e[0], e[1], e[1], e[0]);
    for (int b = 0; b < (int)used.size(); ++b)
      if (ends_[b].size() == 2) add(ends_[b][0], b, ends_[b][1], b);
    if (found.empty()) return found;
    const Lists around = lists_of((int)used.size(), [&](auto use) {
      for (const Tri& t : r_.tris)
        for (int i = 0; i < 3; ++i)
          if (used[t[i]]) use(t[i], t[(i + 1) % 3]), use(t[i], t[(i + 2) % 3]);
    });
    std::erase_if(found, [&](const auto& pair) { return would_pinch(pair, around); });
    return found;
  }

 private:
  /// Whether two vertices have more neighbors in common than those across which they close up: those that
  /// both have on the border, and the apex of the triangle at the end of the slit.
  bool would_pinch(const std::array<int, 2>& pair, const Lists& around) const {
    std::vector<int> common[3];
    for (int i : {0, 1}) {
      common[i].assign(around[pair[i]].begin(), around[pair[i]].end());
      sort_unique(common[i]);
    }
    const bool adjacent = std::binary_search(common[0].begin(), common[0].end(), pair[1]);
    std::set_intersection(common[0].begin(), common[0].end(), common[1].begin(), common[1].end(),
                          std::back_inserter(common[2]));
    return std::count_if(common[2].begin(), common[2].end(), [&](int v) {
             return !std::count(ends_[pair[0]].begin(), ends_[pair[0]].end(), v) ||
                    !std::count(ends_[pair[1]].begin(), ends_[pair[1]].end(), v);
           }) > adjacent;
  }

  Vec3 point(int v) const { return edges_.points[v]; }

  double height(int h) const {
    const Vec3 a = point(origin(r_.tris, h)), b = point(target(r_.tris, h)),
               c = point(origin(r_.tris, prev(h)));
    return norm(cross(b - a, c - a)) / norm(b - a);
  }

  /// Where vertex v lies within open edge e, as a share of its length, if its own border runs along the edge
  /// in both directions; else 0.
  double place_on(int e, int v) const {
    const Tri& t = r_.tris[open_[e] / 3];
    if (std::find(t.begin(), t.end(), v) != t.end()) return 0;
    const Vec3 p = point(v), a = point(edges_.tris[e][0]), b = point(edges_.tris[e][1]);
    const double at = nearest_fraction(p, a, b);
    if (distance_to_segment(p, a, b) > width_ || std::min(at, 1 - at) * norm(b - a) <= width_) return 0;
    auto runs_to = [&](Vec3 end) {
      return std::any_of(ends_[v].begin(), ends_[v].end(), [&](int w) {
        const Vec3 along = point(w) - p, q = p + std::min(1.0, norm(end - p) / norm(along)) * along;
        return dot(along, end - p) > 0 && distance_to_segment(q, a, b) <= width_;
      });
    };
    return runs_to(a) && runs_to(b) ? at : 0;
  }

  const Repair& r_;
  const double width_;
  Mesh edges_;             ///< all points, and the open edges as triangles without area
  std::vector<int> open_;  ///< the half-edge of each
  Lists ends_;             ///< per vertex the other ends of its open edges
};

/// Divides a triangle until no edge has a vertex on it.
void divide(Divided triangle, std::vector<Tri>& tris) {
  std::vector<Divided> todo{std::move(triangle)};
  while (!todo.empty()) {
    Divided d = take_last(todo);
    int i = 0;
    while (i < 3 && d.on[i].empty()) ++i;
    if (i == 3) {
      tris.push_back(d.corner);
      continue;
    }
    const int b = (i + 1) % 3, c = (i + 2) % 3;
    std::vector<int>& on = d.on[i];
    const auto middle = on.begin() + (std::ptrdiff_t)(on.size() / 2);
    todo.push_back(
        {{*middle, d.corner[b], d.corner[c]}, {std::vector<int>(middle + 1, on.end()), d.on[b], {}}});
    todo.push_back(
        {{d.corner[i], *middle, d.corner[c]}, {std::vector<int>(on.begin(), middle), {}, d.on[c]}});
  }
}

/// Merges these pairs of vertices, and drops the triangles between them.
void merge(const std::vector<std::array<int, 2>>& pairs, Repair& r, CleanReport& report) {
  std::vector<int> kept = identity((int)r.vertex.size());
  for (const auto& [a, c] : pairs) kept[c] = a;
  std::vector<char> gone(r.tris.size(), 0);
  for (std::size_t t = 0; t < r.tris.size(); ++t) {
    Tri& c = r.tris[t];
    for (int& v : c) v = kept[v];
    if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) continue;
    gone[t] = 1;
    report.degenerate += r.face[t] >= 0;
    record(report, r.face[t], Fault::degenerate);
  }
  drop(r, gone);
}

}  // namespace

bool close_slits(Repair& r, const std::vector<Vec3>& points, CleanReport& report) {
  std::optional<Slits> slits(std::in_place, r, points, report.holes.slit);
  const std::vector<std::array<int, 2>> ends = slits->find_ends();
  r.opposite.clear();
  if (!ends.empty()) {
    merge(ends, r, report);
    slits.emplace(r, points, report.holes.slit);
  }
  const std::vector<OnEdge> found = slits->find();
  for (std::size_t i = 0; i < found.size();) {
    const int t = found[i].h / 3;
    Divided triangle{r.tris[t], {}};
    for (; i < found.size() && found[i].h / 3 == t; ++i)
      triangle.on[found[i].h % 3].push_back(found[i].vertex);
    std::vector<Tri> pieces;
    divide(std::move(triangle), pieces);
    r.tris[t] = pieces[0];
    for (std::size_t k = 1; k < pieces.size(); ++k) {
      r.tris.push_back(pieces[k]);
      r.face.push_back(r.face[t]);
      r.flipped.push_back(0);
    }
  }
  report.holes.slit_ends += (int)ends.size();
  report.holes.slit_vertices += (int)found.size();
  return !ends.empty() || !found.empty();
}

}  // namespace meshpipe
