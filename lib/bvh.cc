// SPDX-License-Identifier: BSD-3-Clause
#include "lib/bvh.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace meshpipe {
namespace {

constexpr int leaf_size = 4;
constexpr int task_size = 4096;  // smaller subtrees are not worth a task
constexpr double infinity = std::numeric_limits<double>::infinity();

inline double outside(double p, double lo, double hi) { return std::max(std::max(lo - p, p - hi), 0.0); }

inline double squared_distance(const Vec3& p, const Box& box) {
  const double x = outside(p.x, box.lo.x, box.hi.x);
  const double y = outside(p.y, box.lo.y, box.hi.y);
  const double z = outside(p.z, box.lo.z, box.hi.z);
  return x * x + y * y + z * z;
}

/// Nodes of a tree over `count` items: every split halves, so the shape is known beforehand.
int tree_size(int count) {
  // all nodes of a level hold n or n + 1 items
  long long n = count, few = 1, many = 0, total = 0;
  for (;;) {
    // `few` nodes of n items and `many` of n + 1
    total += few + many;
    const bool split_few = n > leaf_size, split_many = n + 1 > leaf_size;
    if (!split_few && !(split_many && many)) return (int)total;
    const long long f = split_few ? few : 0, m = many;
    // n = 2h + r: a node of n gives halves h and h + r; one of n + 1 gives h + r and h + 1
    const long long h = n / 2;
    if (n % 2 == 0) {
      few = 2 * f + m;
      many = m;
    } else {
      few = f;
      many = f + 2 * m;
    }
    n = h;
  }
}

Vec3 segment_weights(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 d = b - a;
  const double dd = dot(d, d);
  const double t = dd > 0 ? std::clamp(dot(p - a, d) / dd, 0.0, 1.0) : 0;
  const Vec3 e = p - lerp(a, b, t);
  return {1 - t, t, dot(e, e)};
}

std::array<double, 3> closest_on_edges(Vec3 p, const std::array<Vec3, 3>& v) {
  std::array<double, 3> best{1, 0, 0};
  double closest = infinity;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vec3 w = segment_weights(p, v[i], v[j]);
    if (w.z < closest) {
      closest = w.z;
      best = {0, 0, 0};
      best[i] = w.x;
      best[j] = w.y;
    }
  }
  return best;
}

}  // namespace

std::array<double, 3> closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  const double area = va + vb + vc;  // squared, of the parallelogram
  // nearly no area: the regions below would be told apart by rounding
  if (!(area > 1e-12 * dot(ab, ab) * dot(ac, ac))) return closest_on_edges(p, {a, b, c});
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = d1 / (d1 - d3);
    return {1 - t, t, 0};
  }
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d2 / (d2 - d6);
    return {1 - t, 0, t};
  }
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - t, t};
  }
  return {va / area, vb / area, vc / area};
}

struct Bvh::Item {
  std::array<double, 3> centre;
  int tri;
};

Bvh::Bvh(const Mesh& mesh) : mesh_(mesh), order_(mesh.tris.size()) {
  const int n = (int)mesh.tris.size();
  if (n == 0) throw std::logic_error("a bvh needs a triangle");
  std::vector<Item> items(n);
  for (int t = 0; t < n; ++t) {
    const Tri& v = mesh.tris[t];
    const Vec3 s = mesh.points[v[0]] + mesh.points[v[1]] + mesh.points[v[2]];
    items[t] = {{s.x, s.y, s.z}, t};
  }
  nodes_.resize(tree_size(n));
  parent_.assign(nodes_.size(), 0);
#pragma omp parallel if (n > 2 * task_size)
#pragma omp single
  build(items.data(), 0, n, 0, 1);
}

void Bvh::build(Item* items, int first, int count, int node, int children) {
  Node& b = nodes_[node];
  if (count <= leaf_size) {
    b.first = first;
    b.count = count;
    b.box = box_of(mesh_, items[first].tri);
    for (int i = first; i < first + count; ++i) {
      order_[i] = items[i].tri;
      b.box = join(b.box, box_of(mesh_, items[i].tri));
    }
    return;
  }
  std::array<double, 3> lo, hi;
  lo.fill(infinity);
  hi.fill(-infinity);
  for (int i = first; i < first + count; ++i)
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], items[i].centre[k]);
      hi[k] = std::max(hi[k], items[i].centre[k]);
    }
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
  const int half = count / 2;
  std::nth_element(items + first, items + first + half, items + first + count,
                   [axis](const Item& x, const Item& y) { return x.centre[axis] < y.centre[axis]; });
  b.first = children;
  b.count = 0;
  parent_[children] = parent_[children + 1] = node;
  // the two children stand side by side, then come the left one's descendants, then the right one's
  const int left = children + 2, right = left + tree_size(half) - 1;
  if (count > task_size) {
#pragma omp task
    build(items, first, half, children, left);
    build(items, first + half, count - half, children + 1, right);
#pragma omp taskwait
  } else {
    build(items, first, half, children, left);
    build(items, first + half, count - half, children + 1, right);
  }
  b.box = join(nodes_[children].box, nodes_[children + 1].box);
}

void Bvh::search(int start, const Vec3& p, double& best, Hit& hit) const {
  struct Entry {
    double distance;
    int node;
  } stack[64];
  int n = 0;
  stack[n++] = {squared_distance(p, nodes_[start].box), start};
  while (n) {
    const Entry e = stack[--n];
    if (e.distance > best) continue;
    const Node& b = nodes_[e.node];
    if (b.count == 0) {
      const double dl = squared_distance(p, nodes_[b.first].box),
                   dr = squared_distance(p, nodes_[b.first + 1].box);
      const bool left_first = dl <= dr;
      const Entry far{left_first ? dr : dl, b.first + left_first};
      const Entry near{left_first ? dl : dr, b.first + !left_first};
      if (far.distance <= best) stack[n++] = far;
      if (near.distance <= best) stack[n++] = near;
      continue;
    }
    for (int i = b.first; i < b.first + b.count; ++i) {
      const Tri& v = mesh_.tris[order_[i]];
      const Vec3 &x = mesh_.points[v[0]], &y = mesh_.points[v[1]], &z = mesh_.points[v[2]];
      const auto w = closest_on_triangle(p, x, y, z);
      const Vec3 d = w[0] * x + w[1] * y + w[2] * z - p;
      const double dd = dot(d, d);
      if (dd < best || (hit.place.face < 0 && dd <= best)) {
        best = dd;
        hit.place = {order_[i], w[0], w[1], w[2]};
        hit.leaf = e.node;
      }
    }
  }
}

Bvh::Hit Bvh::nearest(Vec3 p, double bound) const {
  // a bound that is the very distance must not be cut off by rounding
  double best = std::min(bound * bound * (1 + 1e-12), std::numeric_limits<double>::max());
  Hit hit;
  search(0, p, best, hit);
  if (hit.place.face < 0) return nearest(p);  // the bound was too small after all
  hit.distance = std::sqrt(best);
  return hit;
}

Bvh::Hit Bvh::nearest(Vec3 p, const Hit& close_by) const {
  double best = std::numeric_limits<double>::max();
  Hit hit;
  search(close_by.leaf, p, best, hit);
  for (int node = hit.leaf; node > 0; node = parent_[node]) {
    const int sibling = node % 2 ? node + 1 : node - 1;
    if (squared_distance(p, nodes_[sibling].box) < best) search(sibling, p, best, hit);
  }
  hit.distance = std::sqrt(best);
  return hit;
}

}  // namespace meshpipe
