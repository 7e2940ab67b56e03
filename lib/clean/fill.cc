// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "lib/clean/repair.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

constexpr double impossible = std::numeric_limits<double>::infinity();
/// Weight of squared edge lengths against the area: decides between triangulations of a plane hole, which all
/// have the same area unless they fold.
constexpr double edge_weight = 1e-3;

/// The best triangulation of a loop by dynamic programming: best[i][j] is the least cost of the polygon i,
/// i+1 ... j.
class Polygon {
 public:
  Polygon(const std::vector<Vec3>& corners, const std::vector<char>& joined)
      : p_(corners), n_((int)corners.size()), joined_(joined), cost_(n_ * n_, 0), apex_(n_ * n_, -1) {}

  /// Triangles as places in the loop; none if every triangulation needs an edge that the mesh has already.
  std::vector<Tri> triangles() {
    for (int span = 2; span < n_; ++span)
      for (int i = 0; i + span < n_; ++i) {
        const int j = i + span;
        double least = impossible;
        const bool chord = span < n_ - 1;  // the last edge, n-1 to 0, is the loop's own
        if (!chord || !joined_[i * n_ + j])
          for (int k = i + 1; k < j; ++k) {
            const double c = cost_[i * n_ + k] + cost_[k * n_ + j] + cost(i, k, j);
            if (c < least) {
              least = c;
              apex_[i * n_ + j] = k;
            }
          }
        cost_[i * n_ + j] = least;
      }
    std::vector<Tri> tris;
    if (cost_[n_ - 1] == impossible) return tris;
    std::vector<std::array<int, 2>> stack{{0, n_ - 1}};
    while (!stack.empty()) {
      const auto [i, j] = stack.back();
      stack.pop_back();
      if (j - i < 2) continue;
      const int k = apex_[i * n_ + j];
      tris.push_back({i, k, j});
      stack.push_back({i, k});
      stack.push_back({k, j});
    }
    return tris;
  }

 private:
  double cost(int i, int k, int j) const {
    const Vec3 a = p_[k] - p_[i], b = p_[j] - p_[k], c = p_[i] - p_[j];
    return 0.5 * norm(cross(a, c)) + edge_weight * (dot(a, a) + dot(b, b) + dot(c, c));
  }

  const std::vector<Vec3>& p_;
  const int n_;
  const std::vector<char>& joined_;
  std::vector<double> cost_;
  std::vector<int> apex_;
};

}  // namespace

HoleCounts fill_holes(Repair& r, const std::vector<Vec3>& points, int most) {
  HoleCounts counts;
  // vertices that are copies of one another count as one here: filling may not make two edges or triangles at
  // the same place, even on different sheets
  std::vector<int> spoke(r.vertex.size(), -1), copy(r.vertex.size(), -1), last(r.split.size(), -1);
  for (int h = 0; h < (int)r.opposite.size(); ++h) {
    const int v = origin(r.tris, h);
    if (spoke[v] >= 0) continue;
    spoke[v] = h;
    copy[v] = last[base(r, v)];
    last[base(r, v)] = v;
  }
  std::vector<int> place(r.split.size(), -1);  // in the loop at hand
  for (const std::vector<int>& loop : boundary_loops(r.opposite)) {
    const int n = (int)loop.size();
    if (n > most) continue;
    // a hole is seen from its own side: its corners run against the half-edges of the border
    std::vector<int> vertices;
    std::vector<Vec3> corners;
    bool sound = true;
    for (int i = n - 1; i >= 0; --i) {
      const int v = target(r.tris, loop[i]), p = base(r, v);
      sound = sound && place[p] < 0 && !r.split[p];
      vertices.push_back(v);
      corners.push_back(points[r.vertex[v]]);
      place[p] = n - 1 - i;
    }
    std::vector<char> joined(n * n, 0);
    for (int i = 0; i < n; ++i)
      for (int v = last[base(r, vertices[i])]; v >= 0; v = copy[v])
        for_each_spoke(r.opposite, spoke[v], [&](int g) {
          const int j = place[base(r, target(r.tris, g))], k = place[base(r, origin(r.tris, prev(g)))];
          for (int w : {j, k})
            if (w >= 0) joined[i * n + w] = joined[w * n + i] = 1;
          if (n == 3 && j >= 0 && k >= 0) sound = false;  // the triangle is there
        });
    for (int v : vertices) place[base(r, v)] = -1;
    const std::vector<Tri> tris = sound ? Polygon(corners, joined).triangles() : std::vector<Tri>{};
    if (tris.empty()) {
      ++counts.left;
      continue;
    }
    ++counts.filled;
    counts.triangles += (int)tris.size();
    // half-edge of the mesh that runs from place i to place j, or -1
    std::vector<int> runs(n * n, -1);
    for (int i = 0; i < n; ++i) runs[(i + 1) % n * n + i] = loop[n - 1 - i];
    const int face = ~source(r, *std::min_element(loop.begin(), loop.end()) / 3);
    for (const Tri& t : tris) {
      const int first = 3 * (int)r.tris.size();
      r.tris.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
      r.face.push_back(face);
      r.flipped.push_back(0);
      for (int i = 0; i < 3; ++i) {
        const int a = t[i], b = t[(i + 1) % 3], other = runs[b * n + a];
        runs[a * n + b] = first + i;
        r.opposite.push_back(other);
        if (other >= 0) r.opposite[other] = first + i;
      }
    }
  }
  return counts;
}

}  // namespace meshpipe
