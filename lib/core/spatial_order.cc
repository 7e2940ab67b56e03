// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/spatial_order.h"

#include <algorithm>

#include "lib/core/lists.h"

namespace meshpipe {
namespace {

constexpr int bits = 16;  // of each coordinate on the curve

/// Returns the place of a cell on Hilbert's curve (Skilling, Programming the Hilbert curve, 2004).
std::uint64_t hilbert(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
    for (std::uint32_t& y : x) {
      const std::uint32_t low = q - 1;
      if (y & q) {
        x[0] ^= low;
      } else {
        const std::uint32_t both = (x[0] ^ y) & low;
        x[0] ^= both;
        y ^= both;
      }
    }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t gray = 0;
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
    if (x[2] & q) gray ^= q - 1;
  std::uint64_t place = 0;
  for (int b = bits - 1; b >= 0; --b)
    for (std::uint32_t y : x) place = place << 1 | ((y ^ gray) >> b & 1);
  return place;
}

std::vector<int> along_curve(const std::vector<Vec3>& points) {
  const int n = (int)points.size();
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Vec3& p : points) low = lower(low, p), high = upper(high, p);
  const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  const double cells = extent > 0 ? ((1 << bits) - 1) / extent : 0;
  auto cell = [&](double x) { return (std::uint32_t)(cells * x); };
  std::vector<std::pair<std::uint64_t, int>> keys(n);
#pragma omp parallel for schedule(static) if (n > 10000)
  for (int v = 0; v < n; ++v) {
    const Vec3 p = points[v] - low;
    keys[v] = {hilbert({cell(p.x), cell(p.y), cell(p.z)}), v};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order(n);
  for (int i = 0; i < n; ++i) order[i] = keys[i].second;
  return order;
}

}  // namespace

std::vector<int> new_rows(const std::vector<int>& order) {
  std::vector<int> row(order.size());
  for (int i = 0; i < (int)order.size(); ++i) row[order[i]] = i;
  return row;
}

std::vector<int> number_by_first_use(std::vector<Tri>& tris, std::size_t n) {
  std::vector<int> number(n, -1), vertex;
  for (Tri& t : tris)
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = (int)vertex.size();
        vertex.push_back(v);
      }
      v = number[v];
    }
  return vertex;
}

SpatialOrder spatial_order(const Mesh& mesh) {
  SpatialOrder order{along_curve(mesh.points), {}};
  const std::vector<int> row = new_rows(order.vertices);
  std::vector<int> first;
  first.reserve(mesh.tris.size());
  for (const auto& [a, b, c] : mesh.tris) first.push_back(std::min({row[a], row[b], row[c]}));
  order.tris = lists_by((int)mesh.points.size(), first).row;
  return order;
}

void rearrange(Mesh& mesh, const SpatialOrder& order) {
  const std::vector<int> row = new_rows(order.vertices);
  mesh.points = rearranged(mesh.points, order.vertices);
  mesh.tris = rearranged(mesh.tris, order.tris);
  for (Tri& t : mesh.tris) t = {row[t[0]], row[t[1]], row[t[2]]};
}

}  // namespace meshpipe
