// SPDX-License-Identifier: BSD-3-Clause
// Single points far out of their surface, as scanners and broken files have them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "lib/clean/clean.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

/// What the edges at a vertex lead to.
struct Rim {
  Vec3 low, high, sum;
  double nearest = std::numeric_limits<double>::infinity();
  int count = 0;

  void add(Vec3 at, double distance) {
    if (count == 0) low = high = at;
    low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
    sum = sum + at;
    nearest = std::min(nearest, distance);
    ++count;
  }
};

std::vector<Rim> rims_of(const std::vector<Vec3>& points, const std::vector<Tri>& tris,
                         const std::vector<int>& same) {
  std::vector<Rim> rims(points.size());
  for (const Tri& t : tris)
    for (int i = 0; i < 3; ++i) {
      const int v = same[t[i]];
      for (int w : {same[t[(i + 1) % 3]], same[t[(i + 2) % 3]]})
        if (w != v) rims[v].add(points[w], norm(points[w] - points[v]));
    }
  return rims;
}

bool sticks_out(const Rim& rim, double extents) {
  return rim.count > 2 && rim.nearest > extents * norm(rim.high - rim.low);
}

/// Has a triangle two edges longer than `extents` times the third, as those at a vertex that sticks out have?
bool has_long_triangles(const Surface& s, double extents) {
  return std::any_of(s.tris.begin(), s.tris.end(), [&](const Tri& t) {
    double edge[3];
    for (int i = 0; i < 3; ++i) edge[i] = norm(s.points[t[(i + 1) % 3]] - s.points[t[i]]);
    std::sort(edge, edge + 3);
    return edge[1] > extents * edge[0];
  });
}

}  // namespace

int flatten_spikes(Surface& s, double extents) {
  if (!has_long_triangles(s, extents)) return 0;
  const std::vector<int> same = first_equal(s.points, used_points(s));
  const std::vector<Rim> rims = rims_of(s.points, s.tris, same);
  int n = 0;
  for (std::size_t v = 0; v < same.size(); ++v) {
    const Rim& rim = rims[same[v]];
    if (!sticks_out(rim, extents)) continue;
    n += same[v] == (int)v;
    s.points[v] = (1.0 / rim.count) * rim.sum;
  }
  return n;
}

int Spikes::parse(const std::string& remark) {
  int n = 0;
  return std::sscanf(remark.c_str(), "spikes %d", &n) == 1 ? n : 0;
}

Spikes find_spikes(const Surface& s) {
  constexpr double extents = 5;   // of their neighbors; edges of sound triangles are no longer than that
  constexpr double most = 0.001;  // of the vertices: more are what the surface consists of
  std::vector<int> same(s.points.size());
  std::iota(same.begin(), same.end(), 0);
  const std::vector<Rim> rims = rims_of(s.points, s.tris, same);
  Spikes found;
  double longest = 0;
  for (int v = 0; v < (int)rims.size(); ++v) {
    if (!sticks_out(rims[v], extents)) continue;
    ++found.count;
    if (!(rims[v].nearest > longest)) continue;
    longest = rims[v].nearest;
    found.longest = s.points[v];
  }
  return found.count <= std::max(1.0, most * (double)rims.size()) ? found : Spikes{};
}

}  // namespace meshpipe
