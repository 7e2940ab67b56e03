// SPDX-License-Identifier: BSD-3-Clause
#include "lib/wrap/voxels.h"

#include <cstdio>

#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"

namespace meshpipe {
namespace {

/// Voxels along alpha (or the offset, where that is larger). Fewer make a coarser wrap, more make it follow
/// the soup better at a cost that grows with the square.
constexpr double voxels_per_alpha = 2.5;
/// Half the diagonal of a voxel in units of its side, rounded up: a voxel whose center is farther from the
/// soup does not meet it.
constexpr double half_diagonal = 0.8661;
/// Blocks are stored this many voxels farther than the ball needs, so that everything that may become
/// boundary has its neighbors stored.
constexpr double spare_voxels = 4;
/// Bytes for a stored block, counted from the arrays: 9 kB in the grid, and up to 700 for each of the about
/// 30 quadrilaterals that come from it.
constexpr double bytes_per_block = 30000;
/// Of voxels, in spacings of doubles: points are fitted within voxels.
constexpr double least_spacing = 10;
/// The least descent of the distance per length on the way into a concave edge: slots whose sides are nearly
/// parallel (below 2 asin 0.25 = 29 degrees) are entered as far as they are wider than alpha.
constexpr double least_descent = 0.25;

using Place3 = std::array<int, 3>;

/// Cubes of 2^level blocks near the soup are divided, level by level, down to blocks. Where there would be
/// more than `most`, it ends early. Sets `count` to the number of blocks, or an estimate.
std::vector<Place3> blocks_near(const Voxels& v, const Bvh& tree, double reach, double most, double& count) {
  int level = 0;
  while ((1 << level) < std::max({v.blocks[0], v.blocks[1], v.blocks[2]})) ++level;
  std::vector<Place3> cubes{{0, 0, 0}}, finer;
  std::vector<char> near;
  for (;; --level) {
    const double width = v.spacing * Voxels::side * (1 << level);
    const int n = (int)cubes.size();
    near.assign(n, 0);
#pragma omp parallel for schedule(dynamic, 64) if (n > 256)
    for (int c = 0; c < n; ++c) {
      const Vec3 center = v.low + width * Vec3{cubes[c][0] + 0.5, cubes[c][1] + 0.5, cubes[c][2] + 0.5};
      const double limit = reach + half_diagonal * width;
      near[c] = tree.nearest(center, 1e300, limit).distance <= limit;
    }
    finer.clear();
    for (int c = 0; c < n; ++c) {
      if (!near[c]) continue;
      if (level == 0) {
        finer.push_back(cubes[c]);
        continue;
      }
      for (int k = 0; k < 8; ++k) {
        const Place3 p{2 * cubes[c][0] + (k & 1), 2 * cubes[c][1] + (k >> 1 & 1), 2 * cubes[c][2] + (k >> 2)};
        bool in_grid = true;
        for (int d = 0; d < 3; ++d) in_grid &= (std::int64_t)p[d] << (level - 1) < v.blocks[d];
        if (in_grid) finer.push_back(p);
      }
    }
    cubes.swap(finer);
    // of the eight parts of a cube, a surface meets about four
    count = (double)cubes.size() * (level == 0 ? 1 : 0.5 * std::pow(4.0, level - 1));
    if (level == 0 || (double)cubes.size() > 8 * most) return cubes;
  }
}

[[noreturn]] void refuse(double bytes, const WrapOptions& o) {
  char line[240];
  std::snprintf(
      line, sizeof line,
      "a wrap with alpha %.4g and offset %.4g takes about %.3g GiB, more than the limit of %.3g GiB; "
      "try --alpha %.3g",
      o.alpha, o.offset, bytes / (1 << 30), (double)o.most_bytes / (1 << 30),
      1.2 * o.alpha * std::sqrt(bytes / (double)o.most_bytes));
  throw BadUsage(line);
}

/// Lays the grid around the soup, with a layer of blocks to spare on all sides, and stores what is near.
Voxels make_grid(const Mesh& soup, const Bvh& tree, const WrapOptions& o, double spacing, double reach,
                 WrapReport& report) {
  Voxels v;
  v.spacing = spacing;
  const Box box = box_of(soup);
  const double block = Voxels::side * spacing, margin = reach + 2 * block;
  // faces along the axes do not lie on voxel sides, where rounding would decide
  const Vec3 shift = spacing * Vec3{0.3719, 0.4177, 0.4553};
  v.low = box.lo - Vec3{margin, margin, margin} - shift;
  const Vec3 size = box.hi - v.low;
  auto blocks = [&](double length) { return std::ceil((length + margin) / block) + 1; };
  const double dense = blocks(size.x) * blocks(size.y) * blocks(size.z);
  if (dense > (double)o.most_bytes / 8) refuse(dense * 8, o);  // so that all three fit an int
  int axis = 0;
  for (double length : {size.x, size.y, size.z}) v.blocks[axis++] = (int)blocks(length);
  const double most_blocks = ((double)o.most_bytes - 5 * dense) / bytes_per_block;
  double count = 0;
  v.place = blocks_near(v, tree, reach, most_blocks, count);
  const double bytes = 5 * dense + bytes_per_block * count;
  report.bytes = (std::int64_t)bytes;
  if (bytes > (double)o.most_bytes) refuse(bytes, o);
  v.stored.assign((std::size_t)dense, -1);
  v.far_outside.assign((std::size_t)dense, 0);
  for (std::size_t b = 0; b < v.place.size(); ++b)
    v.stored[v.block_index(v.place[b][0], v.place[b][1], v.place[b][2])] = (int)b;
  return v;
}

/// Sets the distances, and the states to `inside` where the soup may be, `outside` where a ball of radius
/// `clear` less the offset fits, `open` else.
void measure(Voxels& v, const Bvh& tree, double solid, double clear) {
  const int n = (int)v.place.size();
  v.distance.resize((std::size_t)n * Voxels::volume);
  v.state.resize(v.distance.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int b = 0; b < n; ++b) {
    double known = 1e300;
    for (int i = 0; i < Voxels::volume; ++i) {
      const std::int64_t voxel = (std::int64_t)b * Voxels::volume + i;
      const auto p = v.position(voxel);
      // the voxel before is the neighbor along x, or at the start of a row 8 voxels away
      if (i % Voxels::side == 0) known = 1e300;
      const double d = tree.nearest(v.center(p[0], p[1], p[2]), known).distance;
      known = d + 1.001 * v.spacing;
      v.distance[voxel] = (float)d;
      v.state[voxel] = d <= solid ? Voxels::inside : d > clear ? Voxels::outside : Voxels::open;
    }
  }
}

/// Visits the voxels connected to infinity by the faces of voxels in state `outside`, and calls
/// reached(voxel) for each that is stored; then those not reached are `open`.
template <class Reached>
void flood(Voxels& v, const Reached& reached) {
  std::vector<std::uint8_t> seen(v.state.size(), 0);
  std::fill(v.far_outside.begin(), v.far_outside.end(), 0);
  std::vector<int> far;
  std::vector<std::int64_t> near;
  auto visit = [&](int i, int j, int k) {
    const std::int64_t voxel = v.at(i, j, k);
    if (voxel < 0) {
      if (!v.far_outside[-1 - voxel]) far.push_back((int)(-1 - voxel)), v.far_outside[-1 - voxel] = 1;
    } else if (v.state[voxel] == Voxels::outside && !seen[voxel]) {
      seen[voxel] = 1;
      near.push_back(voxel);
      reached(voxel);
    }
  };
  visit(0, 0, 0);
  while (!far.empty() || !near.empty()) {
    if (!near.empty()) {
      const auto [i, j, k] = v.position(near.back());
      near.pop_back();
      visit(i - 1, j, k), visit(i + 1, j, k), visit(i, j - 1, k);
      visit(i, j + 1, k), visit(i, j, k - 1), visit(i, j, k + 1);
      continue;
    }
    const int b = take_last(far);
    const Place3 p{b % v.blocks[0], b / v.blocks[0] % v.blocks[1], b / v.blocks[0] / v.blocks[1]};
    for (int axis = 0; axis < 3; ++axis)
      for (int step : {-1, 1}) {
        Place3 q = p;
        q[axis] += step;
        if (q[axis] < 0 || q[axis] >= v.blocks[axis]) continue;
        Place3 first{q[0] * Voxels::side, q[1] * Voxels::side, q[2] * Voxels::side};
        if (v.stored[v.block_index(q[0], q[1], q[2])] < 0) {
          visit(first[0], first[1], first[2]);
          continue;
        }
        if (step < 0) first[axis] += Voxels::side - 1;
        for (int s = 0; s < Voxels::side; ++s)
          for (int t = 0; t < Voxels::side; ++t) {
            Place3 x = first;
            x[(axis + 1) % 3] += s;
            x[(axis + 2) % 3] += t;
            visit(x[0], x[1], x[2]);
          }
      }
  }
  for (std::size_t voxel = 0; voxel < v.state.size(); ++voxel)
    if (v.state[voxel] == Voxels::outside && !seen[voxel]) v.state[voxel] = Voxels::open;
}

/// From `front`, voxels outside, makes every open voxel outside that is reached by steps to any of 26
/// neighbors that come nearer to the soup.
void descend(Voxels& v, std::vector<std::int64_t> front) {
  while (!front.empty()) {
    const std::int64_t from = take_last(front);
    const auto [i, j, k] = v.position(from);
    for (int n = 0; n < 27; ++n) {
      const int a = n % 3 - 1, b = n / 3 % 3 - 1, c = n / 9 - 1;
      const std::int64_t to = v.at(i + a, j + b, k + c);
      if (to < 0 || v.state[to] != Voxels::open) continue;
      const double step = v.spacing * std::sqrt((double)(a * a + b * b + c * c));
      if (v.distance[to] > v.distance[from] - least_descent * step) continue;
      v.state[to] = Voxels::outside;
      front.push_back(to);
    }
  }
}

/// Whether the chosen ones of the 2^3 voxels at a grid point (bits of `set`) are connected by faces.
constexpr bool connected(int set) {
  int reached = set & -set;
  for (int again = 0; again < 8; ++again)
    for (int v = 0; v < 8; ++v)
      if (reached >> v & 1) reached |= set & (1 << (v ^ 1) | 1 << (v ^ 2) | 1 << (v ^ 4));
  return reached == set;
}

/// The boundary passes a grid point as one sheet exactly if both its sides are connected.
constexpr auto one_sheet = [] {
  std::array<bool, 256> table{};
  for (int set = 0; set < 256; ++set) table[set] = connected(set) && connected(255 - set);
  return table;
}();

/// Makes voxels inside until the boundary is a manifold: at a grid point where it is not, the voxel outside
/// that is nearest to the soup; first those that settle the matter at once.
void make_manifold(Voxels& v) {
  std::vector<std::int64_t> queue(v.state.size());
  for (std::size_t i = 0; i < queue.size(); ++i) queue[i] = (std::int64_t)(queue.size() - 1 - i);
  while (!queue.empty()) {
    const auto [i, j, k] = v.position(queue.back());
    queue.pop_back();
    std::int64_t around[8];
    int out = 0;
    for (int c = 0; c < 8; ++c) {
      around[c] = v.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
      out |= v.is_outside(around[c]) << c;
    }
    if (one_sheet[out]) continue;
    int best = -1;
    for (int c = 0; c < 8; ++c) {
      if (!(out >> c & 1) || around[c] < 0) continue;
      const bool settles = one_sheet[out & ~(1 << c)];
      const bool best_settles = best >= 0 && one_sheet[out & ~(1 << best)];
      if (best < 0 || settles > best_settles ||
          (settles == best_settles && v.distance[around[c]] < v.distance[around[best]]))
        best = c;
    }
    if (best < 0) throw ContractMissed("the boundary of the voxels is not a manifold far from the input");
    v.state[around[best]] = Voxels::inside;
    const auto [a, b, c] = v.position(around[best]);
    for (int n = 0; n < 8; ++n) {
      const std::int64_t again = v.at(a - (n & 1), b - (n >> 1 & 1), c - (n >> 2));
      if (again >= 0) queue.push_back(again);
    }
  }
}

}  // namespace

Voxels outside_voxels(const Mesh& soup, const Bvh& tree, const WrapOptions& o, WrapReport& report) {
  const double spacing = std::max(o.alpha, o.offset) / voxels_per_alpha;
  const Box box = box_of(soup);
  double far = 0;
  for (const Vec3& p : {box.lo, box.hi}) far = std::max({far, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (const double apart = std::nextafter(far, infinity) - far; spacing < least_spacing * apart)
    throw NotAdmissible("voxels are " + shown(spacing) +
                        " wide, but doubles as large as the coordinates are " + shown(apart) +
                        " apart: try mconvert --center, which moves them to the origin");
  // a path between centers this far away from the soup stays clear of a ball of diameter alpha in between
  const double clear = o.offset + 0.5 * o.alpha + 0.5 * spacing, solid = o.offset + half_diagonal * spacing;
  report.spacing = spacing;
  Voxels v = make_grid(soup, tree, o, spacing, clear + spare_voxels * spacing, report);
  measure(v, tree, solid, clear);
  std::vector<std::int64_t> front;
  flood(v, [&](std::int64_t voxel) { front.push_back(voxel); });
  descend(v, std::move(front));
  make_manifold(v);
  flood(v, [](std::int64_t) {});
  return v;
}

}  // namespace meshpipe
