// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/bvh.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace meshpipe {
namespace {

constexpr int task_size = 4096;  // smaller subtrees are not worth a task

/// The four parts that `count` items are split into: halves of halves.
std::array<int, 4> parts(int count) {
  const int left = count / 2, right = count - left;
  return {left / 2, left - left / 2, right / 2, right - right / 2};
}

/// Nodes of trees over n and over n + 1 items, n >= 1; one item needs none. The parts of both hold n / 4 or
/// n / 4 + 1 items.
std::array<int, 2> tree_sizes(int n) {
  if (n < 4) return {n > 1, 1};
  const std::array<int, 2> below = tree_sizes(n / 4);
  std::array<int, 2> sizes{1, 1};
  for (int i = 0; i < 2; ++i)
    if (n + i > 4)
      for (int p : parts(n + i)) sizes[i] += below[p - n / 4];
  return sizes;
}

std::array<double, 3> closest_on_edges(Vec3 p, const std::array<Vec3, 3>& v) {
  std::array<double, 3> best{1, 0, 0};
  double closest = infinity;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double t = nearest_fraction(p, v[i], v[j]);
    const Vec3 e = p - lerp(v[i], v[j], t);
    if (!(dot(e, e) < closest)) continue;
    closest = dot(e, e);
    best = {0, 0, 0};
    best[i] = 1 - t;
    best[j] = t;
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
  // nearly no area: the regions below would be separated by rounding
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

Place closest_place(const Mesh& mesh, int t, Vec3 p) {
  const auto& [a, b, c] = mesh.tris[t];
  const auto w = closest_on_triangle(p, mesh.points[a], mesh.points[b], mesh.points[c]);
  return {t, w[0], w[1], w[2]};
}
Vec3 closest_point(const Mesh& mesh, int t, Vec3 p) {
  return value_at(closest_place(mesh, t, p), mesh.points, mesh.tris);
}

Box box_of(const Mesh& mesh) {
  Box box = box_of(mesh, 0);
  for (int t = 1; t < (int)mesh.tris.size(); ++t) box = join(box, box_of(mesh, t));
  return box;
}

/// A triangle and its center in own units.
struct Bvh::Item {
  std::array<float, 3> center;
  int tri;
};

Bvh::Bvh(const Mesh& mesh) : mesh_(mesh), order_(mesh.tris.size()) {
  const int n = (int)mesh.tris.size();
  if (n == 0) throw std::logic_error("a bvh needs a triangle");
  const Box all = box_of(mesh);
  center_ = 0.5 * (all.lo + all.hi);
  const Vec3 half = all.hi - center_;
  const double extent = std::max({half.x, half.y, half.z});
  if (extent > 0) scale_ = 1 / extent;
  std::vector<Item> items(n);
#pragma omp parallel for schedule(static) if (n > 2 * task_size)
  for (int t = 0; t < n; ++t) {
    const Tri& v = mesh.tris[t];
    items[t] = {own_units(1.0 / 3 * (mesh.points[v[0]] + mesh.points[v[1]] + mesh.points[v[2]])), t};
  }
  nodes_.resize(std::max(1, tree_sizes(n)[0]));
#pragma omp parallel if (n > 2 * task_size)
#pragma omp single
  build(items.data(), 0, n, 0);
}

void Bvh::refit() {
  for (int i = (int)nodes_.size() - 1; i >= 0; --i)  // children come after their parent
    for (int k = 0; k < 4; ++k) {
      Node& b = nodes_[i];
      if (b.lo[0][k] > b.hi[0][k]) continue;  // no child
      if (b.child[k] < 0) {
        set_child(i, k, b.child[k], box_of(mesh_, -1 - b.child[k]));
        continue;
      }
      const Node& below = nodes_[b.child[k]];
      for (int axis = 0; axis < 3; ++axis) {
        const Four &lo = below.lo[axis], &hi = below.hi[axis];
        b.lo[axis][k] = std::min({lo[0], lo[1], lo[2], lo[3]});
        b.hi[axis][k] = std::max({hi[0], hi[1], hi[2], hi[3]});
      }
    }
}

std::array<float, 3> Bvh::own_units(Vec3 p) const {
  const Vec3 q = scale_ * (p - center_);
  auto within = [](double x) { return (float)std::clamp(x, -1e16, 1e16); };
  return {within(q.x), within(q.y), within(q.z)};
}

void Bvh::set_child(int node, int k, int child, const Box& box) {
  Node& b = nodes_[node];
  b.child[k] = child;
  if (box.lo.x > box.hi.x) {  // no child: farther away than any point
    for (int i = 0; i < 3; ++i) b.lo[i][k] = 1e18f, b.hi[i][k] = -1e18f;
    return;
  }
  const auto lo = own_units(box.lo), hi = own_units(box.hi);
  for (int i = 0; i < 3; ++i) {
    b.lo[i][k] = lo[i] - slack;
    b.hi[i][k] = hi[i] + slack;
  }
}

/// As std::nth_element by the coordinate `axis`, but with no branch that could not be predicted: three times
/// as fast.
template <class Item>
static void select(Item* items, int n, int nth, int axis) {
  auto key = [&](int i) { return items[i].center[axis]; };
  auto median = [](float a, float b, float c) {
    return std::max(std::min(a, b), std::min(std::max(a, b), c));
  };
  // those below the pivot to the front
  auto divide = [&](auto below) {
    int m = 0;
    for (int i = 0; i < n; ++i) {
      const Item x = items[i];
      items[i] = items[m];
      items[m] = x;
      m += below(x.center[axis]);
    }
    return m;
  };
  while (n > 16) {
    const int step = n / 8;
    const float pivot =
        median(median(key(0), key(step), key(2 * step)), median(key(3 * step), key(n / 2), key(5 * step)),
               median(key(6 * step), key(7 * step), key(n - 1)));
    int m = divide([=](float x) { return x < pivot; });
    if (m == 0) {
      m = divide([=](float x) { return x <= pivot; });
      if (nth < m) return;  // all alike
      if (m == 0) break;    // not a number
    }
    if (nth < m) {
      n = m;
    } else {
      items += m;
      n -= m;
      nth -= m;
    }
  }
  std::nth_element(items, items + nth, items + n,
                   [axis](const Item& x, const Item& y) { return x.center[axis] < y.center[axis]; });
}

/// Splits items at place `half` along the longest side of their centers' box.
template <class Item>
static void halve(Item* items, int count, int half) {
  std::array<float, 3> lo = items[0].center, hi = lo;
  for (int i = 1; i < count; ++i)
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], items[i].center[k]);
      hi[k] = std::max(hi[k], items[i].center[k]);
    }
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
  select(items, count, half, axis);
}

Box Bvh::build(Item* items, int first, int count, int node) {
  constexpr Box none{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  std::array<int, 4> part{};
  if (count > 4) {
    part = parts(count);
    const int left = part[0] + part[1];
    halve(items + first, count, left);
    halve(items + first, left, part[0]);
    halve(items + first + left, count - left, part[2]);
  } else {
    for (int k = 0; k < count; ++k) part[k] = 1;
  }
  std::array<Box, 4> box;
  box.fill(none);
  std::array<int, 4> child{}, start{};
  // a node is followed by the trees of its children
  const std::array<int, 2> below = count > 4 ? tree_sizes(count / 4) : std::array<int, 2>{};
  for (int k = 0, at = first, free = node + 1; k < 4; ++k) {
    start[k] = at;
    child[k] = free;
    at += part[k];
    if (part[k] > 1) free += below[part[k] - count / 4];
  }
  const bool tasks = count > task_size;
  for (int k = 0; k < 4; ++k) {
    if (part[k] > 1 && tasks) {
#pragma omp task shared(box)
      box[k] = build(items, start[k], part[k], child[k]);
    } else if (part[k] > 1) {  // a task that is done at once would still cost more than a small tree
      box[k] = build(items, start[k], part[k], child[k]);
    } else if (part[k] == 1) {
      const int t = items[start[k]].tri;
      order_[start[k]] = t;
      box[k] = box_of(mesh_, t);
      child[k] = -1 - t;
    }
  }
  if (tasks) {
#pragma omp taskwait
  }
  Box all = none;
  for (int k = 0; k < 4; ++k) {
    set_child(node, k, child[k], box[k]);
    all = join(all, box[k]);
  }
  return all;
}

/// Visits triangles in the order of their boxes' distances, as far as `most`, which `visit` may lower;
/// `visit` returns whether to stop. distances(node): those of its four children's boxes.
template <class Nodes, class Distances, class Visit>
static void nearest_first(const Nodes& nodes, const float& most, Distances&& distances, Visit&& visit) {
  struct Entry {
    float distance;
    int child;
  } stack[96];
  int n = 0;
  stack[n++] = {0, 0};
  while (n) {
    const Entry e = stack[--n];
    if (e.distance > most) continue;
    if (e.child < 0) {
      if (visit(-1 - e.child)) return;
      continue;
    }
    const auto& node = nodes[e.child];
    const auto each = distances(node);
    // the nearest child on top
    const int bottom = n;
    for (int k = 0; k < 4; ++k) {
      const float d = each[k];
      if (!(d <= most)) continue;
      int at = n++;
      for (; at > bottom && stack[at - 1].distance < d; --at) stack[at] = stack[at - 1];
      stack[at] = {d, node.child[k]};
    }
  }
}

Bvh::Hit Bvh::nearest(Vec3 p, double bound, double enough) const {
  const Hit hit = search(p, bound, enough, nullptr, 0);
  return hit.place.face >= 0 ? hit
                             : search(p, 1e300, enough, nullptr, 0);  // the bound was too small after all
}

Bvh::Hit Bvh::nearest_of(const std::vector<int>& label, int wanted, Vec3 p, double bound,
                         double enough) const {
  return search(p, bound, enough, label.data(), wanted);
}

Bvh::Hit Bvh::search(Vec3 p, double bound, double enough, const int* label, int wanted) const {
  // the boxes are in single precision: what they say is taken with some slack
  constexpr double trust = 1 + 1e-5;
  const auto q = own_units(p);
  double best = std::min(bound * bound * (1 + 1e-12), std::numeric_limits<double>::max());
  auto limit = [&] { return (float)std::min(best * scale_ * scale_ * trust, 1e35); };
  float most = limit();
  Hit hit;
  auto distances = [&](const Node& b) {
    Four sum{};
    for (int k = 0; k < 3; ++k) {
      const Four below = b.lo[k] - q[k], above = q[k] - b.hi[k];
      Four out = below > above ? below : above;
      out = out > 0 ? out : Four{};
      sum += out * out;
    }
    return sum;
  };
  nearest_first(nodes_, most, distances, [&](int t) {
    if (label && label[t] != wanted) return false;
    const Tri& v = mesh_.tris[t];
    const Vec3 &x = mesh_.points[v[0]], &y = mesh_.points[v[1]], &z = mesh_.points[v[2]];
    const auto w = closest_on_triangle(p, x, y, z);
    const Vec3 d = vector_to(w, x, y, z, p);
    const double dd = dot(d, d);
    if (!(dd < best || (hit.place.face < 0 && dd <= best))) return false;
    best = dd;
    most = limit();
    hit.place = {t, w[0], w[1], w[2]};
    return best <= enough * enough;
  });
  hit.distance = std::sqrt(best);
  return hit;
}

Bvh::RayHit Bvh::first_hit(Vec3 p, Vec3 direction, int side) const {
  // the ray in own units, its boxes a little larger than rounding makes them
  constexpr float trust = 1 + 1e-5f, margin = 1e-5f, far = 1e30f;
  const auto q = own_units(p);
  const float d[3] = {(float)direction.x, (float)direction.y, (float)direction.z};
  float inverse[3];
  for (int k = 0; k < 3; ++k) inverse[k] = 1 / (std::abs(d[k]) > 1e-12f ? d[k] : 1e-12f);
  RayHit hit{infinity};
  float most = far;
  auto distances = [&](const Node& b) {
    Four first{}, last = first + most;
    for (int k = 0; k < 3; ++k) {
      const Four lo = (b.lo[k] - margin - q[k]) * inverse[k], hi = (b.hi[k] + margin - q[k]) * inverse[k];
      const Four low = lo < hi ? lo : hi, high = lo < hi ? hi : lo;
      first = low > first ? low : first;
      last = high < last ? high : last;
    }
    const Four missed = Four{} + 2 * far;
    return ((first <= last) & (b.lo[0] <= b.hi[0])) ? first : missed;
  };
  nearest_first(nodes_, most, distances, [&](int face) {
    const auto& [i, j, k] = mesh_.tris[face];
    const Vec3 a = mesh_.points[i], u = mesh_.points[j] - a, v = mesh_.points[k] - a;
    // Moeller and Trumbore 1997
    const Vec3 across = cross(direction, v), from = p - a;
    const double det = dot(u, across);  // against the normal
    if (!(-side * det > 0)) return false;
    const Vec3 over = cross(from, u);
    const double b1 = dot(from, across) / det, b2 = dot(direction, over) / det, t = dot(v, over) / det;
    if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 && t >= 0 && t < hit.distance) {
      hit = {t, face, b1, b2};
      most = (float)std::min(t * scale_ * trust + margin, (double)far);
    }
    return false;
  });
  return hit;
}

}  // namespace meshpipe
