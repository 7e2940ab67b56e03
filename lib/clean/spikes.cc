// SPDX-License-Identifier: BSD-3-Clause
// Single points far out of their surface, as scanners and broken files have them.
#include <algorithm>
#include <map>

#include "lib/clean/clean.h"
#include "lib/core/lists.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

/// What the edges at a vertex lead to.
struct Rim {
  Vec3 low, high, sum;
  double nearest = infinity;
  int count = 0;

  void add(Vec3 at, double distance) {
    if (count == 0) low = high = at;
    low = lower(low, at), high = upper(high, at);
    sum = sum + at;
    nearest = std::min(nearest, distance);
    ++count;
  }
};

/// Flags the vertices opposite to an edge that is shorter than a triangle's others over `extents`, as those
/// are that stick out.
std::vector<char> apexes(const Surface& s, double extents) {
  std::vector<char> flags(s.points.size(), 0);
#pragma omp parallel for schedule(static)
  for (const Tri& t : s.tris) {
    double edge[3];  // opposite to each corner
    for (int i = 0; i < 3; ++i) edge[i] = norm(s.points[t[(i + 2) % 3]] - s.points[t[(i + 1) % 3]]);
    for (int i = 0; i < 3; ++i)
      if (std::min(edge[(i + 1) % 3], edge[(i + 2) % 3]) > extents * edge[i]) {
#pragma omp atomic write
        flags[t[i]] = 1;
      }
  }
  return flags;
}

/// Returns the rims of the vertices flagged.
std::map<int, Rim> rims_of(const Surface& s, const std::vector<int>& same, const std::vector<char>& flags) {
  std::map<int, Rim> rims;
  for (const Tri& t : s.tris)
    for (int i = 0; i < 3; ++i)
      if (const int v = same[t[i]]; flags[v])
        for (int w : {same[t[(i + 1) % 3]], same[t[(i + 2) % 3]]})
          if (w != v) rims[v].add(s.points[w], norm(s.points[w] - s.points[v]));
  return rims;
}

bool sticks_out(const Rim& rim, double extents) {
  return rim.count > 2 && rim.nearest > extents * norm(rim.high - rim.low);
}

}  // namespace

int flatten_spikes(Surface& s, double extents) {
  std::vector<char> flags = apexes(s, extents);
  if (std::count(flags.begin(), flags.end(), 1) == 0) return 0;
  const std::vector<int> same = first_equal(s.points, used_points(s));
  for (std::size_t v = 0; v < same.size(); ++v) flags[same[v]] |= flags[v];
  const std::map<int, Rim> rims = rims_of(s, same, flags);
  int n = 0;
  for (std::size_t v = 0; v < same.size(); ++v) {
    const auto found = rims.find(same[v]);
    if (found == rims.end() || !sticks_out(found->second, extents)) continue;
    n += same[v] == (int)v;
    s.points[v] = (1.0 / found->second.count) * found->second.sum;
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
  std::vector<int> same = identity(s.points.size());
  Spikes found;
  double longest = 0;
  for (const auto& [v, rim] : rims_of(s, same, apexes(s, extents))) {
    if (!sticks_out(rim, extents)) continue;
    ++found.count;
    if (!(rim.nearest > longest)) continue;
    longest = rim.nearest;
    found.longest = s.points[v];
  }
  return found.count <= std::max(1.0, most * (double)same.size()) ? found : Spikes{};
}

}  // namespace meshpipe
