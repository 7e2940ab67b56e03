// SPDX-License-Identifier: BSD-3-Clause
// Bits that resolving self-intersections cuts off.
#include <cmath>

#include "lib/clean/repair.h"
#include "lib/core/topology.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

/// Of the volume of all components: folds of scans that are cut off have a hundredth of that, or less.
constexpr double crumb = 1e-6;

/// Flags points that are not among those of the input.
std::vector<char> new_points(const Mesh& mesh, const Mesh& input) {
  PointNumbers places(input.points.size());
  std::vector<int> number(std::max(mesh.points.size(), input.points.size()));
  places.add(input.points.data(), (int)input.points.size(), number.data());
  const int known = (int)places.points.size();
  places.add(mesh.points.data(), (int)mesh.points.size(), number.data());
  std::vector<char> flags(mesh.points.size());
  for (std::size_t v = 0; v < flags.size(); ++v) flags[v] = number[v] >= known;
  return flags;
}

}  // namespace

std::vector<char> find_crumbs(const Mesh& mesh, const Mesh& input, int& n_crumbs) {
  const std::vector<int> opposite = opposite_halfedges(mesh);
  const std::vector<char> is_new = new_points(mesh, input);
  std::vector<int> component;
  const int n = components(opposite, component);
  std::vector<int> seed(n, -1);
  std::vector<char> cut(n, 0), open(n, 0);
  std::vector<double> volume(n, 0);
  for (int t = 0; t < (int)mesh.tris.size(); ++t) {
    const int c = component[t];
    const auto& [i, j, k] = mesh.tris[t];
    if (seed[c] < 0) seed[c] = i;
    volume[c] += volume6(mesh, t, mesh.points[seed[c]]);  // from near, for the digits
    cut[c] |= is_new[i] | is_new[j] | is_new[k];
    for (int h = 3 * t; h < 3 * t + 3; ++h) open[c] |= opposite[h] < 0;
  }
  double sum = 0;
  for (double v : volume) sum += std::abs(v);
  std::vector<char> flags(mesh.tris.size());
  n_crumbs = 0;
  for (int c = 0; c < n; ++c) {
    cut[c] = cut[c] && !open[c] && std::abs(volume[c]) < crumb * sum;
    n_crumbs += cut[c];
  }
  for (std::size_t t = 0; t < flags.size(); ++t) flags[t] = cut[component[t]];
  return flags;
}

}  // namespace meshpipe
