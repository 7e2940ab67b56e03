// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/needles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/core/bvh.h"

namespace meshpipe {
namespace {

/// Below it no good triangle fits between two feature edges.
constexpr double sharp_angle = 40 * std::numbers::pi / 180;
constexpr float needle_kappa = 0.1F;  ///< the default limit of the contract
constexpr double touching = 0.1;  ///< of a triangle's longest edge: a vertex this close stands for the corner
/// Of the isosceles triangle's kappa, what a needle needs. kappa falls as the sine of the base angles, so the
/// base may lean by 60 degrees; and no triangle of a sector that two share is worse.
constexpr double lean = 0.5;

double longest_edge(const Mesh& mesh, int t) {
  return std::max({edge_length(mesh, 3 * t), edge_length(mesh, 3 * t + 1), edge_length(mesh, 3 * t + 2)});
}

/// The corners of a surface as a tree: a degenerate triangle for each.
Mesh corner_points(const Connectivity& surface, const std::vector<Sector>& sectors) {
  Mesh points;
  for (const Sector& s : sectors) {
    const int n = (int)points.points.size();
    points.points.push_back(surface.point(surface.from(s.first)));
    points.tris.push_back({n, n, n});
  }
  return points;
}

/// Unit vector along the middle of a sector.
Vec3 middle(const Connectivity& s, const Sector& sector) {
  Vec3 sum;
  for (int g = sector.first, k = 0; k < sector.triangles; ++k, g = s.opposite[prev(g)])
    sum = sum + normalized(s.point(s.to(g)) - s.point(s.from(g))) +
          normalized(s.point(s.apex(g)) - s.point(s.from(g)));
  return normalized(sum);
}

/// Pairs each sector of the result with the nearest corner of the reference of its kind, and of several at
/// the same vertex with the one in its direction; of those that have the same corner only the nearest stays.
/// Returns the corner's angle per sector, negative: none.
std::vector<double> angles_of_corners(const Connectivity& result, const std::vector<Sector>& sectors,
                                      const Connectivity& reference, bool whole) {
  std::vector<double> angles(sectors.size(), -1), distance(sectors.size());
  std::vector<Sector> corners = needle_sectors(reference);
  std::erase_if(corners, [&](const Sector& s) { return s.whole != whole; });
  if (corners.empty()) return angles;
  auto vertex = [&](const Sector& s) { return reference.from(s.first); };
  std::stable_sort(corners.begin(), corners.end(), [&](auto& a, auto& b) { return vertex(a) < vertex(b); });
  auto best_at = [&](int corner, Vec3 direction) {
    const int v = vertex(corners[corner]);
    while (corner > 0 && vertex(corners[corner - 1]) == v) --corner;
    int best = corner;
    double most = -2;
    for (; corner < (int)corners.size() && vertex(corners[corner]) == v; ++corner)
      if (const double d = dot(middle(reference, corners[corner]), direction); d > most)
        most = d, best = corner;
    return best;
  };
  const Mesh points = corner_points(reference, corners);
  const Bvh tree(points);
  std::vector<int> nearest(sectors.size(), -1);
  std::vector<double> least(corners.size(), infinity);
  for (std::size_t i = 0; i < sectors.size(); ++i) {
    if (sectors[i].whole != whole) continue;
    const auto hit = tree.nearest(result.point(result.from(sectors[i].first)));
    if (hit.distance > touching * longest_edge(result.mesh, sectors[i].first / 3)) continue;
    nearest[i] = best_at(hit.place.face, middle(result, sectors[i]));
    distance[i] = hit.distance;
    least[nearest[i]] = std::min(least[nearest[i]], hit.distance);
  }
  for (std::size_t i = 0; i < sectors.size(); ++i)
    if (nearest[i] >= 0 && distance[i] <= least[nearest[i]]) angles[i] = corners[nearest[i]].apex();
  return angles;
}

}  // namespace

std::vector<char> forced_needles(const Connectivity& result, const std::vector<float>& kappas,
                                 const Connectivity& reference) {
  std::vector<char> forced(kappas.size(), 0);
  // at twice the angle, even a leaning triangle is better than a needle
  const std::vector<Sector> sectors = needle_sectors(result, 1 / lean);
  for (const bool whole : {false, true}) {
    const std::vector<double> angles = angles_of_corners(result, sectors, reference, whole);
    for (std::size_t i = 0; i < sectors.size(); ++i) {
      if (angles[i] < 0) continue;
      // half the sine of the wider angle: that of the corner, or of what the result has there
      const double s = std::sin(0.5 * std::max(angles[i], sectors[i].apex()));
      const double least = lean * 4 * s * (1 - s);
      for (int g = sectors[i].first, k = 0; k < sectors[i].triangles; ++k) {
        if (kappas[g / 3] <= needle_kappa && kappas[g / 3] >= least) forced[g / 3] = 1;
        g = result.opposite[prev(g)];
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
