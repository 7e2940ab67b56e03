// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/needles.h"

#include <algorithm>
#include <numbers>

#include "lib/core/bvh.h"

namespace meshpipe {
namespace {

constexpr double degree = std::numbers::pi / 180;
/// kappa of an isosceles triangle is 0.1 at an apex of 3 degrees; a vertex without feature edges needs at
/// least three triangles.
constexpr double needle_angle = 3 * degree;
constexpr double sharp_angle = 40 * degree;  ///< below it no good triangle fits between two feature edges
constexpr float needle_kappa = 0.1F;         ///< the default limit of the contract
constexpr double touching = 0.1;  ///< of a triangle's longest edge: a corner this close touches the triangle

bool is_feature(const Connectivity& s, int h) { return s.is_border(h) || s.is_model(h); }

/// Angle of the triangle of half-edge h at its origin.
double corner_angle(const Connectivity& s, int h) {
  const Vec3 p = s.point(s.from(h));
  return angle(s.point(s.to(h)) - p, s.point(s.apex(h)) - p);
}

}  // namespace

std::vector<NeedleCorner> needle_corners(const Connectivity& surface) {
  std::vector<NeedleCorner> corners;
  for (int h = 0; h < surface.n_half_edges(); ++h) {
    const bool bounded = is_feature(surface, h);
    const double limit = bounded ? needle_angle : 3 * needle_angle;
    double sum = corner_angle(surface, h);
    int first = h;
    bool closed = false;
    for (int g = h; sum < limit && !is_feature(surface, prev(g)) && !closed;) {
      g = surface.opposite[prev(g)];
      first = std::min(first, g);
      closed = g == h;
      if (!closed) sum += corner_angle(surface, g);
    }
    // a fan between feature edges is found from its first edge, a closed one from its smallest half-edge
    if (sum < limit && (bounded || (closed && first == h)))
      corners.push_back({surface.point(surface.from(h)), bounded ? sum : sum / 3});
  }
  return corners;
}

std::vector<char> forced_needles(const Mesh& mesh, const std::vector<float>& kappas,
                                 const std::vector<NeedleCorner>& corners) {
  std::vector<char> forced(mesh.tris.size(), 0);
  std::vector<int> bad;
  for (int t = 0; t < (int)kappas.size(); ++t)
    if (!(kappas[t] > needle_kappa)) bad.push_back(t);
  if (bad.empty() || corners.empty()) return forced;
  auto point = [&](int t, int i) { return mesh.points[mesh.tris[t][i]]; };
  std::vector<double> length(bad.size());
  std::vector<std::pair<int, int>> uses;  // vertex, place in `bad`
  Mesh boxes;  // the surroundings of each bad triangle, as a segment between opposite corners of its box
  for (int i = 0; i < (int)bad.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      length[i] = std::max(length[i], norm(point(bad[i], (k + 1) % 3) - point(bad[i], k)));
      uses.push_back({mesh.tris[bad[i]][k], i});
    }
    const Box box = box_of(mesh, bad[i]);
    const double reach = touching * length[i];
    boxes.points.push_back(box.lo - Vec3{reach, reach, reach});
    boxes.points.push_back(box.hi + Vec3{reach, reach, reach});
    boxes.tris.push_back({2 * i, 2 * i + 1, 2 * i + 1});
  }
  std::sort(uses.begin(), uses.end());
  const Bvh tree(boxes);
  std::vector<int> reached, seen(bad.size(), -1);
  for (int corner = 0; corner < (int)corners.size(); ++corner) {
    const Vec3 p = corners[corner].point;
    reached.clear();
    tree.overlapping({p, p}, [&](int i) {
      const Vec3 a = point(bad[i], 0), b = point(bad[i], 1), c = point(bad[i], 2);
      const auto w = closest_on_triangle(p, a, b, c);
      if (norm(w[0] * a + w[1] * b + w[2] * c - p) <= touching * length[i])
        reached.push_back(i), seen[i] = corner;
    });
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const int t = bad[reached[k]];
      forced[t] = 1;
      for (int v : mesh.tris[t])
        for (auto at = std::lower_bound(uses.begin(), uses.end(), std::pair{v, -1});
             at != uses.end() && at->first == v; ++at) {
          const int i = at->second;
          const Vec3 center = 1.0 / 3 * (point(bad[i], 0) + point(bad[i], 1) + point(bad[i], 2));
          if (seen[i] == corner || norm(center - p) * corners[corner].angle > length[i]) continue;
          seen[i] = corner;
          reached.push_back(i);
        }
    }
  }
  return forced;
}

double kappa_off_corners(const Connectivity& surface, const Quality& quality, int& worst) {
  const auto& tris = surface.mesh.tris;
  const int n = (int)tris.size();
  std::vector<char> sharp(surface.n_vertices(), 0);
  for (int h = 0; h < 3 * n; ++h) {
    if (!is_feature(surface, h)) continue;
    double sum = corner_angle(surface, h);
    for (int g = h; sum < sharp_angle && !is_feature(surface, prev(g));)
      sum += corner_angle(surface, g = surface.opposite[prev(g)]);
    if (sum < sharp_angle) sharp[surface.from(h)] = 1;
  }
  std::vector<char> close = sharp;
  for (const Tri& t : tris)
    if (sharp[t[0]] || sharp[t[1]] || sharp[t[2]]) close[t[0]] = close[t[1]] = close[t[2]] = 1;
  worst = -1;
  for (int t = 0; t < n; ++t) {
    const Tri& v = tris[t];
    if (!close[v[0]] && !close[v[1]] && !close[v[2]] &&
        (worst < 0 || quality.kappas[t] < quality.kappas[worst]))
      worst = t;
  }
  return worst < 0 ? 1 : quality.kappas[worst];
}

}  // namespace meshpipe
