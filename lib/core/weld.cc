// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace meshpipe {
namespace {

std::uint64_t mix(std::uint64_t x) {  // a bijection that spreads every bit (multiply and fold, twice)
  x = (x ^ x >> 32) * 0x9E3779B97F4A7C15u;
  x = (x ^ x >> 29) * 0xD6E8FEB86659FD93u;
  return x ^ x >> 32;
}

std::uint64_t hash(const Vec3& p) {
  auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 + 0 is 0
  return mix(bits(p.x) + mix(bits(p.y) + mix(bits(p.z))));
}

}  // namespace

PointNumbers::PointNumbers(std::size_t expected) : slot_(std::bit_ceil(2 * expected + 64), -1) {
  points.reserve(expected);
}

void PointNumbers::make_room(std::size_t n) {
  std::vector<int>().swap(slot_);
  slot_.assign(std::bit_ceil(4 * (points.size() + n)), -1);
  const std::size_t mask = slot_.size() - 1;
  for (int v = 0; v < (int)points.size(); ++v) {
    std::size_t i = hash(points[v]) & mask;
    while (slot_[i] >= 0) i = (i + 1) & mask;
    slot_[i] = v;
  }
}

void PointNumbers::add(const Vec3* p, int n, int* numbers) {
  constexpr int block = 48;
  std::size_t place[block];
  for (int first = 0; first < n; first += block) {
    const int m = std::min(block, n - first);
    if (2 * (points.size() + m) > slot_.size()) make_room(m);
    const std::size_t mask = slot_.size() - 1;
    for (int k = 0; k < m; ++k) {
      place[k] = hash(p[first + k]) & mask;
      __builtin_prefetch(&slot_[place[k]]);
    }
    for (int k = 0; k < m; ++k)
      if (const int v = slot_[place[k]]; v >= 0) __builtin_prefetch(&points[v]);
    for (int k = 0; k < m; ++k) {
      const Vec3& q = p[first + k];
      std::size_t i = place[k];
      while (slot_[i] >= 0 && !(points[slot_[i]] == q)) i = (i + 1) & mask;
      if (slot_[i] < 0) {
        slot_[i] = (int)points.size();
        points.push_back(q);
      }
      numbers[first + k] = slot_[i];
    }
  }
}

std::vector<int> first_equal(const std::vector<Vec3>& points, const std::vector<char>& used) {
  const int n = (int)points.size();
  std::vector<int> same(n), first;  // the latter: by the number of a distinct point
  PointNumbers distinct(points.size());
  constexpr int block = 1024;
  Vec3 p[block];
  int of[block], number[block];
  for (int v = 0; v < n;) {
    int m = 0;
    for (; v < n && m < block; ++v) {
      same[v] = v;
      if (!used[v]) continue;
      p[m] = points[v];
      of[m++] = v;
    }
    distinct.add(p, m, number);
    for (int k = 0; k < m; ++k) {
      if (number[k] == (int)first.size()) first.push_back(of[k]);
      same[of[k]] = first[number[k]];
    }
  }
  return same;
}

void weld(Mesh& mesh) {
  PointNumbers distinct(mesh.points.size() / 6);
  for (Tri& t : mesh.tris) {
    const Vec3 p[3] = {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
    distinct.add(p, 3, t.data());
  }
  mesh.points = std::move(distinct.points);
}

int merge_near(const std::vector<Vec3>& points, const std::vector<char>& used, double tolerance,
               std::vector<int>& same) {
  const int n = (int)points.size();
  // Cells of at least the tolerance's size, a power of two: the division is exact. Where a double does not
  // tell neighboring cells apart, points that differ are farther apart than the tolerance.
  const double size = std::exp2(std::ceil(std::log2(std::max(tolerance, 1e-200))) + 1), per_size = 1 / size;
  auto cell_of = [&](const Vec3& p) {
    return Vec3{std::floor(p.x * per_size), std::floor(p.y * per_size), std::floor(p.z * per_size)};
  };
  const std::size_t mask = std::bit_ceil(2 * points.size() + 2) - 1;
  std::vector<int> slot(mask + 1, -1);  // the last vertex kept in a cell,
  std::vector<int> before(n, -1);       // and the one before it in the same cell
  auto find = [&](const Vec3& c) {
    std::size_t i = hash(c) & mask;
    while (slot[i] >= 0 && !(cell_of(points[slot[i]]) == c)) i = (i + 1) & mask;
    return i;
  };
  int merged = 0;
  for (int v = 0; v < n; ++v) {
    if (!used[v] || same[v] != v) continue;
    const Vec3 home = cell_of(points[v]);
    int nearest = -1;
    double least = tolerance;
    for (int k = 0; k < 27; ++k) {
      const Vec3 c{home.x + (k % 3 - 1), home.y + (k / 3 % 3 - 1), home.z + (k / 9 - 1)};
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

}  // namespace meshpipe
