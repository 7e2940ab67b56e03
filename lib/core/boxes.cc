// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/boxes.h"

#include <algorithm>
#include <array>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"
#include "lib/core/parallel.h"
#include "lib/core/spatial_order.h"
#include "lib/core/triangle_count.h"

namespace meshpipe {
namespace {

/// In half the memory that doubles take.
struct Item {
  std::array<float, 3> middle;
  int triangle;
};

void split(std::vector<Item>::iterator first, std::vector<Item>::iterator last, std::ptrdiff_t most,
           std::vector<std::vector<int>>& boxes) {
  const std::ptrdiff_t n = last - first, count = (n + most - 1) / most;
  if (count <= 1) {
    std::vector<int>& box = boxes.emplace_back();
    for (auto i = first; i != last; ++i) box.push_back(i->triangle);
    std::sort(box.begin(), box.end());
    return;
  }
  std::array<float, 3> lo = first->middle, hi = lo;
  for (auto i = first; i != last; ++i)
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], i->middle[k]), hi[k] = std::max(hi[k], i->middle[k]);
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
  const auto middle = first + n * (count / 2) / count;
  std::nth_element(first, middle, last, [axis](const Item& a, const Item& b) {
    return std::pair(a.middle[axis], a.triangle) < std::pair(b.middle[axis], b.triangle);
  });
  split(first, middle, most, boxes);
  split(middle, last, most, boxes);
}

/// Cubes that fill the box of a mesh.
class Grid {
 public:
  Grid(const Mesh& mesh, double side, double most) {
    const Box box = box_of(mesh);
    lo_ = box.lo;
    const Vec3 d = box.hi - box.lo;
    if (!(side > 1e-6 * norm(d))) side = std::max(1e-6 * norm(d), 1e-300);  // a mesh without area
    while ((d.x / side + 1) * (d.y / side + 1) * (d.z / side + 1) > most) side *= 1.25;
    side_ = side;
    n_ = {(int)(d.x / side) + 1, (int)(d.y / side) + 1, (int)(d.z / side) + 1};
  }
  int size() const { return n_[0] * n_[1] * n_[2]; }
  /// Calls f for the cubes that meet a box, or those at the border that are nearest.
  template <class F>
  void for_cubes(const Box& box, F f) const {
    const std::array<int, 3> a = cube(box.lo), b = cube(box.hi);
    for (int k = a[2]; k <= b[2]; ++k)
      for (int j = a[1]; j <= b[1]; ++j)
        for (int i = a[0]; i <= b[0]; ++i) f((k * n_[1] + j) * n_[0] + i);
  }
  /// The same for a triangle, halved until its pieces are no larger than cubes.
  template <class F>
  void for_cubes(Vec3 a, Vec3 b, Vec3 c, F f) const {
    const double bc = norm(c - b), ca = norm(a - c), ab = norm(b - a), longest = std::max({bc, ca, ab});
    if (longest <= side_) return for_cubes({lower(lower(a, b), c), upper(upper(a, b), c)}, f);
    if (longest == ca) std::swap(b, c), std::swap(a, b);
    if (longest == bc && longest != ca) std::swap(a, b), std::swap(b, c);
    const Vec3 middle = lerp(a, b, 0.5);
    for_cubes(a, middle, c, f);
    for_cubes(middle, b, c, f);
  }

 private:
  std::array<int, 3> cube(Vec3 p) const {
    const Vec3 d = (1 / side_) * (p - lo_);
    return {(int)std::clamp(d.x, 0.0, n_[0] - 1.0), (int)std::clamp(d.y, 0.0, n_[1] - 1.0),
            (int)std::clamp(d.z, 0.0, n_[2] - 1.0)};
  }
  Vec3 lo_;
  double side_;
  std::array<int, 3> n_;
};

/// For each tile, the triangles of a mesh in cubes that it has, too, but not its own; `tile`: per triangle.
Lists triangles_in_cubes(const Mesh& mesh, const Grid& grid, const Lists& tiles_at, int tiles,
                         const std::vector<int>& own) {
  constexpr int chunk = 1 << 14;
  const int n = (int)mesh.tris.size(), chunks = (n + chunk - 1) / chunk;
  std::vector<std::vector<std::pair<int, int>>> found(chunks);
  parallel_for(chunks, [&](int k) {
    std::vector<int> near;
    for (int t = k * chunk; t < std::min(n, (k + 1) * chunk); ++t) {
      const auto [a, b, c] = mesh.tris[t];
      near.clear();
      grid.for_cubes(mesh.points[a], mesh.points[b], mesh.points[c], [&](int cube) {
        for (int tile : tiles_at[cube])
          if ((own.empty() || own[t] != tile) && std::find(near.begin(), near.end(), tile) == near.end())
            near.push_back(tile);
      });
      for (int tile : near) found[k].push_back({tile, t});
    }
  });
  return lists_of(tiles, [&](auto add) {
    for (const auto& pairs : found)
      for (const auto& [tile, t] : pairs) add(tile, t);
  });
}

}  // namespace

std::vector<std::vector<int>> split_into_boxes(const Mesh& mesh, const std::vector<int>& triangles,
                                               int most) {
  std::vector<Item> items;
  items.reserve(triangles.size());
  for (int t : triangles) {
    const Vec3 m = centroid(mesh, t) - centroid(mesh, triangles[0]);  // floats have seven digits
    items.push_back({{(float)m.x, (float)m.y, (float)m.z}, t});
  }
  std::vector<std::vector<int>> boxes;
  if (!items.empty()) split(items.begin(), items.end(), most, boxes);
  return boxes;
}

Lists around_tiles(const Mesh& mesh, const std::vector<std::vector<int>>& tiles, double reach,
                   const Mesh* reference, double least) {
  constexpr double edges_per_cube = 4;
  const int count = (int)tiles.size(), n = (int)mesh.tris.size();
  const Grid grid(mesh, edges_per_cube * size_for_count(total_area(mesh), n), std::max(1000.0, 0.5 * n));
  std::vector<int> own(n, -1);
  std::vector<std::vector<int>> cubes(count);
  parallel_for(count, [&](int i) {
    std::vector<char> seen(grid.size());
    for (int t : tiles[i]) {
      own[t] = i;
      Box box = box_of(mesh, t);
      const Vec3 d = box.hi - box.lo;
      const double r = std::max(least, reach * std::max({d.x, d.y, d.z}));
      box.lo = box.lo - Vec3{r, r, r}, box.hi = box.hi + Vec3{r, r, r};
      grid.for_cubes(box, [&](int cube) {
        if (!seen[cube]) seen[cube] = 1, cubes[i].push_back(cube);
      });
    }
  });
  const Lists tiles_at = lists_of(grid.size(), [&](auto add) {
    for (int i = 0; i < count; ++i)
      for (int cube : cubes[i]) add(cube, i);
  });
  return reference ? triangles_in_cubes(*reference, grid, tiles_at, count, {})
                   : triangles_in_cubes(mesh, grid, tiles_at, count, own);
}

Mesh part_of(const Mesh& mesh, std::span<const int> triangles, std::vector<int>* vertices) {
  Mesh part;
  part.tris.reserve(triangles.size());
  for (int t : triangles) part.tris.push_back(mesh.tris[t]);
  std::vector<int> rows = number_by_first_use(part.tris, mesh.points.size());
  part.points = rearranged(mesh.points, rows);
  if (vertices) *vertices = std::move(rows);
  return part;
}

}  // namespace meshpipe
