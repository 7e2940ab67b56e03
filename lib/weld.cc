// SPDX-License-Identifier: BSD-3-Clause
#include "lib/weld.h"

#include <algorithm>
#include <bit>

namespace meshpipe {
namespace {

std::uint64_t mix(std::uint64_t x) {  // a bijection that spreads every bit (multiply and fold, twice)
  x = (x ^ x >> 32) * 0x9E3779B97F4A7C15u;
  x = (x ^ x >> 29) * 0xD6E8FEB86659FD93u;
  return x ^ x >> 32;
}

using Cell = std::array<std::int64_t, 3>;

std::uint64_t hash(const Cell& c) {
  return mix((std::uint64_t)c[0] + mix((std::uint64_t)c[1] + mix((std::uint64_t)c[2])));
}

}  // namespace

std::vector<int> first_equal(const std::vector<Vec3>& points, const std::vector<char>& used) {
  const int n = (int)points.size();
  std::vector<int> same(n);
  // as large as a soup needs, whose vertices come six times each; it grows for other surfaces
  std::size_t mask = std::bit_ceil(points.size() / 3 + 64) - 1, stored = 0;
  std::vector<int> slot(mask + 1, -1);
  auto hash_of = [&](const Vec3& p) {
    auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 + 0 is 0
    return mix(bits(p.x) + mix(bits(p.y) + mix(bits(p.z))));
  };
  // in blocks, so that what the table and the points hold is on its way when it is needed
  constexpr int block = 32;
  std::size_t place[block];
  for (int first = 0; first < n; first += block) {
    const int end = std::min(first + block, n);
    if (2 * (stored + block) > slot.size()) {
      std::vector<int> old = std::move(slot);
      mask = 2 * mask + 1;
      slot.assign(mask + 1, -1);
      for (int v : old) {
        if (v < 0) continue;
        std::size_t i = hash_of(points[v]) & mask;
        while (slot[i] >= 0) i = (i + 1) & mask;
        slot[i] = v;
      }
    }
    for (int v = first; v < end; ++v) {
      place[v - first] = hash_of(points[v]) & mask;
      __builtin_prefetch(&slot[place[v - first]]);
    }
    for (int v = first; v < end; ++v)
      if (const int w = slot[place[v - first]]; w >= 0) __builtin_prefetch(&points[w]);
    for (int v = first; v < end; ++v) {
      same[v] = v;
      if (!used[v]) continue;
      std::size_t i = place[v - first];
      while (slot[i] >= 0 && !(points[slot[i]] == points[v])) i = (i + 1) & mask;
      if (slot[i] < 0) {
        slot[i] = v;
        ++stored;
      }
      same[v] = slot[i];
    }
  }
  return same;
}

int merge_near(const std::vector<Vec3>& points, const std::vector<char>& used, double tolerance,
               std::vector<int>& same) {
  const int n = (int)points.size();
  Vec3 lo = n ? points[0] : Vec3{}, hi = lo;
  for (const Vec3& p : points) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  // cells of the tolerance's size, but never more than 2^40 along a side, which a double counts exactly
  const double size = std::max(tolerance, norm(hi - lo) * 0x1p-40);
  if (!(size > 0)) return 0;
  auto cell_of = [&](const Vec3& p) {
    return Cell{(std::int64_t)std::floor((p.x - lo.x) / size), (std::int64_t)std::floor((p.y - lo.y) / size),
                (std::int64_t)std::floor((p.z - lo.z) / size)};
  };
  const std::size_t mask = std::bit_ceil(2 * points.size() + 2) - 1;
  std::vector<int> slot(mask + 1, -1);  // the last vertex kept in a cell,
  std::vector<int> before(n, -1);       // and the one before it in the same cell
  auto find = [&](const Cell& c) {
    std::size_t i = hash(c) & mask;
    while (slot[i] >= 0 && cell_of(points[slot[i]]) != c) i = (i + 1) & mask;
    return i;
  };
  int merged = 0;
  for (int v = 0; v < n; ++v) {
    if (!used[v] || same[v] != v) continue;
    const Cell home = cell_of(points[v]);
    int nearest = -1;
    double least = tolerance;
    for (int k = 0; k < 27; ++k) {
      const Cell c{home[0] + k % 3 - 1, home[1] + k / 3 % 3 - 1, home[2] + k / 9 - 1};
      for (int w = slot[find(c)]; w >= 0; w = before[w]) {
        const double d = norm(points[w] - points[v]);
        if (d < least || (d == least && (nearest < 0 || w < nearest))) {
          least = d;
          nearest = w;
        }
      }
    }
    if (nearest >= 0) {
      same[v] = nearest;
      ++merged;
    } else {
      const std::size_t i = find(home);
      before[v] = slot[i];
      slot[i] = v;
    }
  }
  for (int v = 0; v < n; ++v) same[v] = same[same[v]];
  return merged;
}

void weld(Mesh& mesh) {
  std::vector<char> used(mesh.points.size(), 0);
  for (const Tri& t : mesh.tris)
    for (int v : t) used[v] = 1;
  const std::vector<int> same = first_equal(mesh.points, used);
  std::vector<int> number(mesh.points.size(), -1);
  std::vector<Vec3> points;
  for (Tri& t : mesh.tris)
    for (int& v : t) {
      int& n = number[same[v]];
      if (n < 0) {
        n = (int)points.size();
        points.push_back(mesh.points[v]);
      }
      v = n;
    }
  mesh.points = std::move(points);
}

}  // namespace meshpipe
