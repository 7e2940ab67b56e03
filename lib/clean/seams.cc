// SPDX-License-Identifier: BSD-3-Clause
// Borders that would fit if their points were not slightly off, as where each triangle has its own points.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

#include "lib/clean/repair.h"
#include "lib/core/bvh.h"
#include "lib/core/edges.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

/// Which points are copies of one.
struct Limits {
  double credible;  ///< an edge at least this many times as long as their distance is no error of its ends
  double gap;       ///< no other border vertex is nearer than this many times their distance
};
/// Points that are welded: nothing is in sight between errors of a thousandth of an edge and edges. A cube
/// of 1200 triangles of their own has partners on all borders up to errors of 3e-4 of its edges.
constexpr Limits certain{1000, 10};
/// Points that a message names: copies with errors of up to an eighth of an edge, which may be details.
constexpr Limits likely{8, 3};

/// Edges of more border triangles are not closed: their number of pairs would be large.
constexpr std::size_t most_sheets = 8;

Tri welded(const Tri& t, const std::vector<int>& same) { return {same[t[0]], same[t[1]], same[t[2]]}; }
bool is_degenerate(const Tri& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// The border edges of a surface that fit others.
class Seams {
 public:
  /// `same`: per vertex the one that it is welded with; `open`: as open_edges returns them.
  Seams(const Mesh& mesh, const std::vector<int>& same, const std::vector<int>& open, const Limits& limits)
      : points_(mesh.points), limits_(limits), n_open_((int)open.size()) {
    if (open.empty()) return;
    std::vector<char> on_border(points_.size(), 0);
    for (int h : open)
      for (int v : {same[origin(mesh.tris, h)], same[target(mesh.tris, h)]})
        if (!std::exchange(on_border[v], 1)) border_.push_back(v);
    std::sort(border_.begin(), border_.end());
    shortest_.assign(points_.size(), infinity);
    for (int t = 0; t < (int)mesh.tris.size(); ++t) {
      const Tri w = welded(mesh.tris[t], same);
      if (!(on_border[w[0]] || on_border[w[1]] || on_border[w[2]]) || is_degenerate(w)) continue;
      tris_.push_back(w);
      for (int i = 0; i < 3; ++i) {
        open_.push_back(std::binary_search(open.begin(), open.end(), 3 * t + i));
        const int a = w[i], b = w[(i + 1) % 3];
        const double length = norm(points_[a] - points_[b]);
        shortest_[a] = std::min(shortest_[a], length);
        shortest_[b] = std::min(shortest_[b], length);
      }
    }
    group_ = identity(points_.size());
    find_groups();
    find_edges();
  }

  int border_edges() const { return n_open_; }
  int closed_edges() const { return closed_; }

  /// Merges in `same` the vertices of groups that close edges; returns their number, and raises `within` to
  /// the largest distance between two of them.
  int merge(std::vector<int>& same, double& within) const {
    if (closed_ == 0) return 0;
    std::vector<int> first(same.size(), -1), kept = identity(same.size());
    int count = 0;
    for (int v : border_) {
      if (!closes_[v]) continue;
      int& f = first[group_[v]];
      if (f < 0) {
        f = v;
        continue;
      }
      kept[v] = f;
      within = std::max(within, norm(points_[f] - points_[v]));
      ++count;
    }
    for (int& v : same) v = kept[v];
    return count;
  }

 private:
  /// Groups border vertices with the first one that is near.
  void find_groups() {
    Mesh spots{points_, {}};
    for (int v : border_) spots.tris.push_back({v, v, v});
    const Bvh tree(spots);
    auto near = [&](int v, double reach, auto visit) {
      const Vec3 r{reach, reach, reach};
      tree.overlapping({points_[v] - r, points_[v] + r}, [&](int i) {
        const double d = norm(points_[border_[i]] - points_[v]);
        if (d <= reach) visit(border_[i], d);
      });
    };
    std::vector<char> grouped(points_.size(), 0);
    spread_.assign(points_.size(), 0);
    for (int v : border_) {
      if (grouped[v]) continue;
      grouped[v] = 1;
      near(v, shortest_[v] / limits_.credible, [&](int w, double d) {
        if (grouped[w] || !(d * limits_.credible <= shortest_[w])) return;
        grouped[w] = 1;
        group_[w] = v;
        spread_[v] = std::max(spread_[v], d);
      });
    }
    std::vector<char> unclear(points_.size(), 0);
    for (int v : border_)
      if (spread_[v] > 0)
        near(v, limits_.gap * spread_[v], [&](int w, double) { unclear[v] |= group_[w] != v; });
    for (int v : border_)
      if (unclear[group_[v]]) group_[v] = v;
  }

  /// Finds the edges that groups close.
  void find_edges() {
    if (std::all_of(border_.begin(), border_.end(), [&](int v) { return group_[v] == v; })) return;
    closes_.assign(points_.size(), 0);
    std::vector<Tri> grouped = tris_;
    for (Tri& t : grouped)
      for (int& v : t) v = group_[v];
    for_each_edge(grouped, (int)points_.size(), [&](std::span<const EdgeUse> uses) {
      if (uses.size() < 2 || uses.size() > most_sheets) return;
      const int a = origin(grouped, half_edge(uses[0])), b = target(grouped, half_edge(uses[0]));
      const double spread = std::max(spread_[a], spread_[b]);
      for (std::size_t i = 0; i < uses.size(); ++i) {
        if (!open_[half_edge(uses[i])]) return;
        for (std::size_t k = 0; k < i; ++k)
          if (folded(half_edge(uses[i]), half_edge(uses[k]), spread)) return;
      }
      closed_ += (int)uses.size();
      for (EdgeUse e : uses) closes_[origin(tris_, half_edge(e))] = closes_[target(tris_, half_edge(e))] = 1;
    });
  }

  /// Whether the triangles of two half-edges lie on each other, as of sheets that run along each other. Of
  /// triangles no higher than the errors of their corners this is not seen.
  bool folded(int h, int g, double spread) const {
    constexpr double least_height = 10, thickness = 3;  // in errors; sheets that bound a solid diverge
    const Vec3 a = points_[origin(tris_, h)], along = points_[target(tris_, h)] - a;
    auto away = [&](int k) {
      const Vec3 to = points_[origin(tris_, prev(k))] - a;
      return to - dot(to, along) / dot(along, along) * along;
    };
    const Vec3 p = away(h), q = away(g);
    const double low = std::min(norm(p), norm(q)), high = std::max(norm(p), norm(q));
    return dot(p, q) > 0 && low >= least_height * spread && norm(cross(p, q)) <= thickness * spread * high;
  }

  const std::vector<Vec3>& points_;
  Limits limits_;
  int n_open_;                    ///< border edges
  std::vector<Tri> tris_;         ///< at border vertices
  std::vector<char> open_;        ///< their half-edges without a neighbor
  std::vector<double> shortest_;  ///< edge of each border vertex
  std::vector<int> border_;       ///< their vertices, ascending
  std::vector<int> group_;        ///< the first vertex of each one's group,
  std::vector<double> spread_;    ///< and how far others are from it
  std::vector<char> closes_;      ///< vertices on edges that have found a partner,
  int closed_ = 0;                ///< and the number of those half-edges
};

}  // namespace

std::vector<int> open_edges(const Mesh& mesh, const std::vector<int>& same) {
  std::vector<Tri> tris;
  std::vector<int> of, open;
  for (int t = 0; t < (int)mesh.tris.size(); ++t)
    if (const Tri w = welded(mesh.tris[t], same); !is_degenerate(w)) tris.push_back(w), of.push_back(t);
  for_each_edge(tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]);
    if (uses.size() == 1) open.push_back(3 * of[h / 3] + h % 3);
  });
  std::sort(open.begin(), open.end());
  return open;
}

int merge_seams(const Mesh& mesh, std::vector<int> open, std::vector<int>& same, double& within) {
  constexpr int most_passes = 10;  // what is merged no longer makes its neighbors unclear
  int count = 0;
  for (int pass = 0; pass < most_passes; ++pass) {
    const int n = Seams(mesh, same, open, certain).merge(same, within);
    count += n;
    if (n == 0) break;
    open = open_edges(mesh, same);
  }
  return count;
}

Gaps find_gaps(const Surface& surface, const CleanReport& report) {
  const bool points_are_distinct = report.copies == 0 && !report.sheets.kept;
  if (points_are_distinct && report.sheets.border.empty()) return {};
  std::vector<int> same = points_are_distinct ? identity(surface.points.size())
                                              : first_equal(surface.points, used_points(surface));
  const Seams seams(surface, same, points_are_distinct ? report.sheets.border : open_edges(surface, same),
                    likely);
  Gaps found{seams.closed_edges(), seams.border_edges(), 0};
  if (2 * found.closed < found.edges || found.closed == 0) return {};
  seams.merge(same, found.within);
  double shortest = infinity;
  for (const Tri& t : surface.tris)
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      if (same[a] != same[b]) shortest = std::min(shortest, norm(surface.points[a] - surface.points[b]));
    }
  found.within = rounded_up(found.within);
  return found.within < shortest ? found : Gaps{};
}

std::string Gaps::text() const {
  char text[128];
  std::snprintf(text, sizeof text, "%d of %d border edges have another one within %g", closed, edges, within);
  return text;
}

Gaps gaps_of(const std::vector<std::string>& remarks) {
  Gaps found, g;
  const char* pattern = "gaps %d of %d border edges have another one within %lf";
  for (const std::string& r : remarks)
    if (std::sscanf(r.c_str(), pattern, &g.closed, &g.edges, &g.within) == 3) found = g;
  return found;
}

}  // namespace meshpipe
