// SPDX-License-Identifier: BSD-3-Clause
#include "lib/mesh2d/subdivide.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lib/core/error.h"
#include "lib/mesh2d/refine.h"

namespace meshpipe {
namespace {

// Measured together on nine smooth surfaces: half of the vertices of a valence other than six are gone.
constexpr double straight = 0.9;  // of two segments of a line: what joins their ends has at least this length
constexpr Spacing apart{0.6, 0.6};  // what is nearer was squeezed in the mesh of twice the size
constexpr int enough = 2;           // vertices per line point that stays: with fewer all must fit the lines
constexpr int sweeps = 4, sweeps_between = 2, rounds = 3;
constexpr int depth = 4;       // flips: each one more multiplies the search by the edges around
constexpr double sound = 0.5;  // mean ratio of a triangle: smoothing repairs better ones

/// The segments of a mesh with every other point of its lines: not of corners, nor where lines end.
std::vector<FixedEdge> join_pairs(const SiteMesh& m, const std::vector<FixedEdge>& segments) {
  std::vector<int> degree(m.cdt.points.size());
  for (const FixedEdge& s : segments) ++degree[s.a], ++degree[s.b];
  std::vector<FixedEdge> joined;
  for (const FixedEdge& s : segments) {
    FixedEdge* last = joined.empty() ? nullptr : &joined.back();
    const bool alone = last && last->b == s.a && degree[s.a] == 2;
    const Vec3 a = m.site[alone ? last->a : s.a].space, b = m.site[s.a].space, c = m.site[s.b].space;
    if (alone && norm(c - a) > straight * (norm(b - a) + norm(c - b)))
      last->b = s.b, degree[s.b] = 0;  // a pair takes no third
    else
      joined.push_back(s);
  }
  return joined;
}

/// Removes pairs of dislocations as remove_dislocations of mrelax does: by flips that cost nothing in valence
/// until the last gains.
class Untangler {
 public:
  explicit Untangler(SiteMesh& mesh) : m_(mesh), cdt_(mesh.cdt), excess_(cdt_.points.size(), -6) {
    for (int h = 0; h < 3 * (int)cdt_.tris.size(); ++h) {
      ++excess_[cdt_.origin(h)];
      // the regular number of triangles at a border is three
      if (cdt_.opposite[h] < 0) ++excess_[cdt_.origin(h)], excess_[cdt_.target(h)] += 2;
    }
  }

  void run() {
    for (int v = m_.line_points; v < (int)cdt_.points.size(); ++v)
      if (excess_[v] != 0) unravel_at(v, depth, 0);
  }

 private:
  /// Area of a triangle over that of the equilateral one with the same sum of squared sides.
  double mean_ratio(int a, int b, int c) const {
    const Vec3 p = m_.site[a].space, u = m_.site[b].space - p, v = m_.site[c].space - p, w = v - u;
    return 2 * std::sqrt(3.0) * norm(cross(u, v)) / (dot(u, u) + dot(v, v) + dot(w, w));
  }

  bool unravel_at(int v, int flips, int gained) {
    std::vector<int> edges;
    cdt_.around(v, [&](int h) { edges.push_back(h), edges.push_back(next(h)); });
    return std::any_of(edges.begin(), edges.end(), [&](int h) { return unravel(h, flips, gained); });
  }

  /// Keeps at most `flips` flips that begin with the edge of h, if there are such that gain.
  bool unravel(int h, int flips, int gained) {
    if (cdt_.fixed[h] || cdt_.opposite[h] < 0) return false;
    const int a = cdt_.origin(h), b = cdt_.target(h), c = cdt_.apex(h), d = cdt_.apex(cdt_.opposite[h]);
    gained += 2 * (2 - excess_[a] - excess_[b] + excess_[c] + excess_[d]);
    if (gained > 0 || (gained == 0 && flips == 1) || !cdt_.can_flip(h)) return false;
    const double least = std::min({sound, mean_ratio(a, b, c), mean_ratio(b, a, d)});
    if (std::min(mean_ratio(a, d, c), mean_ratio(b, c, d)) < least) return false;
    auto flip = [&](int e, int by) {
      cdt_.flip(e);
      excess_[a] -= by, excess_[b] -= by, excess_[c] += by, excess_[d] += by;
    };
    flip(h, 1);
    if (gained < 0) return true;
    for (int v : {a, b, c, d})
      if (excess_[v] != 0 && unravel_at(v, flips - 1, gained)) return true;
    flip(cdt_.half_edge(c, d), -1);
    return false;
  }

  SiteMesh& m_;
  Cdt& cdt_;
  std::vector<int> excess_;  ///< neighbors beyond the regular number
};

/// The mesh of twice the size; `row`: of its line points in `m`.
SiteMesh coarse_mesh(const SiteMesh& m, const SizeMetric& twice, std::vector<FixedEdge> segments,
                     std::vector<int>& row) {
  std::vector<int> number(m.cdt.points.size(), -1);
  std::vector<Vec2> uv;
  std::vector<Site> site;
  for (FixedEdge& s : segments)
    for (int* v : {&s.a, &s.b}) {
      if (number[*v] < 0) {
        number[*v] = (int)row.size();
        row.push_back(*v);
        uv.push_back(m.cdt.points[*v]);
        site.push_back(twice.at(m.site[*v].place));
      }
      *v = number[*v];
    }
  SiteMesh coarse{Cdt(std::move(uv), segments), std::move(site), (int)row.size(), m.most_points, {}};
  refine_frontal(coarse, twice);
  smooth_in_plane(coarse, twice, sweeps);
  for (int i = 0; i < rounds; ++i) {
    Untangler(coarse).run();
    smooth_in_plane(coarse, twice, sweeps_between, false);
  }
  return coarse;
}

}  // namespace

bool insert_subdivided(SiteMesh& m, const SizeMetric& field, const std::vector<FixedEdge>& segments,
                       int stay) try {
  std::vector<int> near;  // per vertex of the coarse mesh: itself in `m`, or a vertex next to it
  const SiteMesh coarse = coarse_mesh(m, SizeMetric(field, 2), join_pairs(m, segments), near);
  const Cdt& cdt = coarse.cdt;
  const int on_lines = (int)near.size(), inside = (int)cdt.points.size() - on_lines;
  if (inside < on_lines || inside < enough * stay) return false;
  std::vector<int> order(near.size());
  std::iota(order.begin(), order.end(), 0);
  near.resize(cdt.points.size(), -1);
  auto insert = [&](Vec2 p, int from) {
    const int t = m.cdt.walk(p, m.cdt.at[from]);
    return t >= 0 && insert_site(m, p, field.at(p, m.site[from].place.face), t, apart)
               ? (int)m.cdt.points.size() - 1
               : from;
  };
  // from the lines on, so that walks are short and no line is in their way
  for (std::size_t i = 0; i < order.size(); ++i)
    cdt.around(order[i], [&](int h) {
      for (int v : {cdt.target(h), cdt.apex(h)})
        if (near[v] < 0) near[v] = insert(cdt.points[v], near[order[i]]), order.push_back(v);
    });
  for (int v : order)
    cdt.around(v, [&](int h) {
      if (!cdt.fixed[h] && h < cdt.opposite[h])
        insert(lerp(cdt.points[v], cdt.points[cdt.target(h)], 0.5), near[v]);
    });
  return true;
} catch (const GoalMissed&) {
  return false;
}

}  // namespace meshpipe
