// SPDX-License-Identifier: BSD-3-Clause
// Vertices that only rounding separates.
#include <algorithm>
#include <cmath>

#include "lib/clean/repair.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

/// Copies of a point in single precision were rounded once, and differ by at most one spacing of the largest
/// coordinate; in double precision they differ by what functions such as sin(pi) leave, up to 100 spacings.
constexpr double single_noise = 0x1p-23, double_noise = 0x1p-45;
/// An edge this many tolerances long is credible: it is a feature of the surface, not an error of its ends.
constexpr double credible = 100;

}  // namespace

double coordinate_noise(const Mesh& mesh, const std::vector<char>& used) {
  double largest = 0;
  bool single = true;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    const Vec3& p = mesh.points[v];
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    single = single && p.x == (float)p.x && p.y == (float)p.y && p.z == (float)p.z;
  }
  return largest * (single ? single_noise : double_noise);
}

std::vector<char> ends_of_short_edges(const Mesh& mesh, const std::vector<int>& same, double tolerance) {
  std::vector<char> short_ends;
  for (const Tri& t : mesh.tris)
    for (int i = 0; i < 3; ++i) {
      const int a = same[t[i]], b = same[t[(i + 1) % 3]];
      if (a == b) continue;
      const Vec3 d = mesh.points[a] - mesh.points[b];
      if (!(dot(d, d) <= tolerance * tolerance)) continue;
      short_ends.resize(mesh.points.size(), 0);
      short_ends[a] = short_ends[b] = 1;
    }
  return short_ends;
}

int merge_noise(const Mesh& mesh, const std::vector<char>& candidates, double tolerance,
                std::vector<int>& same) {
  std::vector<int> merged = same;
  if (candidates.empty() || merge_near(mesh.points, candidates, tolerance, merged) == 0) return 0;
  std::vector<double> shortest(mesh.points.size(), infinity);
  for (const Tri& t : mesh.tris)
    for (int i = 0; i < 3; ++i) {
      const int a = merged[t[i]], b = merged[t[(i + 1) % 3]];
      if (a == b) continue;
      const double length = norm(mesh.points[a] - mesh.points[b]);
      shortest[a] = std::min(shortest[a], length);
      shortest[b] = std::min(shortest[b], length);
    }
  int count = 0;
  for (std::size_t v = 0; v < same.size(); ++v) {
    const int kept = merged[v];
    if (kept == same[v] || !(shortest[kept] >= credible * tolerance && std::isfinite(shortest[kept])))
      continue;
    count += same[v] == (int)v;
    same[v] = kept;
  }
  return count;
}

}  // namespace meshpipe
