// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lib/clean/repair.h"
#include "lib/core/bvh.h"
#include "lib/core/predicates.h"
#include "lib/core/ray.h"

namespace meshpipe {
namespace {

/// Returns the components that contain each closed component: all its sample vertices lie inside, except
/// those that lie on the container. A component with all samples on another is flagged in `unclear`.
std::vector<std::vector<int>> containers(const Repair& r, const std::vector<Vec3>& points,
                                         const std::vector<int>& component, const std::vector<char>& closed,
                                         std::vector<char>& unclear) {
  constexpr int samples = 5;
  const int n = (int)closed.size();
  Mesh mesh;
  mesh.points = points;
  std::vector<int> of;
  std::vector<std::vector<int>> members(n), inside(n);
  for (std::size_t t = 0; t < r.tris.size(); ++t) {
    if (!closed[component[t]]) continue;
    members[component[t]].push_back((int)of.size());
    of.push_back(component[t]);
    mesh.tris.push_back({r.vertex[r.tris[t][0]], r.vertex[r.tris[t][1]], r.vertex[r.tris[t][2]]});
  }
  const Bvh tree(mesh);
  double end = points[mesh.tris[0][0]].x;
  for (const Tri& t : mesh.tris)
    for (int v : t) end = std::max(end, points[v].x);
  std::vector<int> hits, touched, within, all;  // components
  for (int c = 0; c < n; ++c) {
    if (!closed[c]) continue;
    all.clear();
    touched.clear();
    for (int i = 0; i < samples; ++i) {
      const Vec3 p = points[mesh.tris[members[c][i * (members[c].size() - 1) / (samples - 1)]][0]];
      hits.clear();
      tree.overlapping({p, {end, p.y, p.z}}, [&](int t) {
        if (of[t] == c) return;
        const Vec3 x = points[mesh.tris[t][0]], y = points[mesh.tris[t][1]], z = points[mesh.tris[t][2]];
        if (ray_crossing(p, x, y, z) != 0)
          hits.push_back(of[t]);
        else if (line_passes(p, x, y, z) && orient3d(x, y, z, p) == 0)
          touched.push_back(of[t] * samples + i);
      });
      std::sort(hits.begin(), hits.end());
      for (std::size_t j = 0; j < hits.size();) {
        std::size_t k = j;
        while (k < hits.size() && hits[k] == hits[j]) ++k;
        if ((k - j) % 2) all.push_back(hits[j] * samples + i);
        j = k;
      }
    }
    sort_unique(touched);
    std::sort(all.begin(), all.end());
    auto count = [&](const std::vector<int>& v,
                     int d) {  // samples of component d that are not on it, or all on it
      int k = 0;
      for (auto at = std::lower_bound(v.begin(), v.end(), d * samples); at != v.end() && *at / samples == d;
           ++at)
        k += &v == &touched || !std::binary_search(touched.begin(), touched.end(), *at);
      return k;
    };
    for (std::size_t j = 0; j < all.size(); ++j) {
      const int d = all[j] / samples;
      if (j && all[j - 1] / samples == d) continue;
      const int on = count(touched, d);
      if (on < samples && count(all, d) == samples - on) inside[c].push_back(d);
    }
    for (int x : touched)
      if (count(touched, x / samples) == samples) unclear[c] = 1;
  }
  return inside;
}

}  // namespace

bool face_outward(Repair& r, const std::vector<Vec3>& points, const std::vector<int>& component, int n) {
  std::vector<char> closed(n, 1);
  std::vector<int> seed(n, -1);
  std::vector<double> volume(n, 0), area(n, 0);
  for (int h = 0; h < (int)r.opposite.size(); ++h)
    if (r.opposite[h] < 0) closed[component[h / 3]] = 0;
  for (int t = 0; t < (int)r.tris.size(); ++t) {
    const int c = component[t];
    if (!closed[c]) continue;
    if (seed[c] < 0) seed[c] = r.tris[t][0];
    const Vec3 twice = area_vector(r, points, t);  // places from near, for the digits
    volume[c] += dot(point(r, points, r.tris[t][0]) - point(r, points, seed[c]), twice) / 6;
    area[c] += 0.5 * norm(twice);
  }
  std::vector<char> inward(n, 0), mixed(n, 0), unclear(n, 0);
  int n_closed = 0, n_inward = 0;
  for (int c = 0; c < n; ++c) {
    const double least = 1e-12 * area[c] * std::sqrt(area[c]);
    closed[c] = closed[c] && std::abs(volume[c]) > least;
    inward[c] = volume[c] < 0;
    n_closed += closed[c];
    n_inward += closed[c] && inward[c];
  }
  std::vector<std::vector<int>> inside(n);
  if (n_closed > 1) inside = containers(r, points, component, closed, unclear);
  if (n_inward == 0)
    return std::any_of(inside.begin(), inside.end(), [](const auto& of) { return !of.empty(); });
  auto outermost = [&](int c) {
    for (int d : inside[c])
      if (inside[d].empty()) return d;
    return c;
  };
  for (int c = 0; c < n; ++c)
    if (closed[c] && inward[c]) mixed[outermost(c)] = 1;
  for (int t = 0; t < (int)r.tris.size(); ++t) {
    const int c = component[t];
    if (closed[c] && !unclear[c] && mixed[outermost(c)] && inward[c] != (char)(inside[c].size() % 2))
      flip(r, t);
  }
  return false;
}

}  // namespace meshpipe
