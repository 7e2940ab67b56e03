// SPDX-License-Identifier: BSD-3-Clause
// Surfaces that divide space into many regions: bricks, nested spheres, and Voronoi diagrams as labeled
// images have them. A grid's cubes are cut into tetrahedra as in march.cc; one with corners of two to four
// labels holds pieces of sheets, which meet along lines and in points where the labels' distances are equal.
#include <algorithm>
#include <array>
#include <limits>

#include "lib/core/connectivity.h"
#include "lib/core/random.h"
#include "lib/core/weld.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

constexpr double inset = 0.02;  // of an edge: vertices keep off its ends

/// Appends a triangle on points of its own, with its normal along `up`; nothing if it has no area.
void add_triangle(Mesh& mesh, std::array<Vec3, 3> p, Vec3 up) {
  const Vec3 n = area_vector(p[0], p[1], p[2]);
  if (!(norm(n) > 0)) return;
  if (dot(n, up) < 0) std::swap(p[1], p[2]);
  const int first = (int)mesh.points.size();
  mesh.points.insert(mesh.points.end(), p.begin(), p.end());
  mesh.tris.push_back({first, first + 1, first + 2});
}

/// Divides along a c.
void add_quad(Mesh& mesh, Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 up) {
  add_triangle(mesh, {a, b, c}, up);
  add_triangle(mesh, {a, c, d}, up);
}

/// A grid of labels, and what decides between them: the nearest seed; 0 outside the unit ball.
class Image {
 public:
  Image(int n_seeds, bool ball, double h, int seed) : ball_(ball) {
    const double half = ball ? 1 : 0.5;
    n_ = std::max(4, (int)std::ceil(2 * half / h)) + (ball ? 4 : 0);
    h_ = 2 * half / (n_ - (ball ? 4 : 0));
    lo_ = ball ? -1 - 2 * h_ : 0;
    spread(n_seeds, seed);
  }
  Mesh smooth() const;
  Mesh blocks() const;

 private:
  int at(int i, int j, int k) const { return (k * (n_ + 1) + j) * (n_ + 1) + i; }
  Vec3 point(int p) const {
    const int m = n_ + 1;
    return {lo_ + h_ * (p % m), lo_ + h_ * (p / m % m), lo_ + h_ * (p / m / m)};
  }
  int label_at(Vec3 p) const;
  void spread(int n_seeds, int seed);
  /// Negative where label a is nearer than b.
  double difference(int a, int b, Vec3 p) const {
    if (b == 0) return norm(p) - 1;
    if (a == 0) return 1 - norm(p);
    return dot(p - seeds_[a - 1], p - seeds_[a - 1]) - dot(p - seeds_[b - 1], p - seeds_[b - 1]);
  }
  Vec3 equal_point(std::vector<int> corners) const;
  void cut(Mesh& mesh, std::array<int, 4> corner) const;
  void cut_side(Mesh& mesh, std::array<int, 3> corner, Vec3 up) const;

  bool ball_;
  int n_;
  double h_, lo_;
  std::vector<Vec3> seeds_;
  std::vector<int> label_;
};

int Image::label_at(Vec3 p) const {
  if (ball_ && norm(p) > 1) return 0;
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < seeds_.size(); ++s)
    if (const double d = dot(p - seeds_[s], p - seeds_[s]); d < least) least = d, best = (int)s + 1;
  return best;
}

/// Random seeds, which then move to the middle of their regions a few times (Lloyd).
void Image::spread(int n_seeds, int seed) {
  Random random(seed);
  const double half = ball_ ? 1 : 0.5;
  while ((int)seeds_.size() < n_seeds) {
    Vec3 p;
    for (double* x : {&p.x, &p.y, &p.z})
      *x = half * (ball_ ? 2 * random.uniform() - 1 : 2 * random.uniform());
    if (!ball_ || norm(p) < 1) seeds_.push_back(p);
  }
  label_.resize((std::size_t)(n_ + 1) * (n_ + 1) * (n_ + 1));
  constexpr int rounds = 6;
  for (int round = 0;; ++round) {
#pragma omp parallel for schedule(static)
    for (int p = 0; p < (int)label_.size(); ++p) label_[p] = label_at(point(p));
    if (round == rounds) return;
    std::vector<Vec3> sum(n_seeds + 1);
    std::vector<int> count(n_seeds + 1, 0);
    for (int p = 0; p < (int)label_.size(); ++p)
      sum[label_[p]] = sum[label_[p]] + point(p), ++count[label_[p]];
    for (int s = 1; s <= n_seeds; ++s)
      if (count[s]) seeds_[s - 1] = (1.0 / count[s]) * sum[s];
  }
}

/// The point between two to four grid points of as many labels where all of these are equally near, by linear
/// interpolation, kept off the rim.
Vec3 Image::equal_point(std::vector<int> corners) const {
  std::sort(corners.begin(), corners.end());  // rounds alike wherever it is needed
  const int n = (int)corners.size();
  std::vector<int> labels;
  for (int c : corners) labels.push_back(label_[c]);
  std::sort(labels.begin(), labels.end());
  double m[4][5];
  for (int row = 0; row < n; ++row) {
    for (int c = 0; c < n; ++c)
      m[row][c] = row ? difference(labels.back(), labels[row - 1], point(corners[c])) : 1;
    m[row][n] = row == 0;
  }
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int row = c + 1; row < n; ++row)
      if (std::abs(m[row][c]) > std::abs(m[pivot][c])) pivot = row;
    std::swap(m[c], m[pivot]);
    for (int row = 0; row < n; ++row)
      if (row != c)
        for (int k = n; k >= c; --k) m[row][k] -= m[row][c] / m[c][c] * m[c][k];
  }
  double weight[4], sum = 0;
  for (int c = 0; c < n; ++c) {
    const double w = m[c][n] / m[c][c];
    sum += weight[c] = std::isfinite(w) ? std::clamp(w, inset, 1.0) : 1;
  }
  Vec3 p;
  for (int c = 0; c < n; ++c) p = p + weight[c] / sum * point(corners[c]);
  return p;
}

/// Adds the pieces of sheets in a tetrahedron: cones of one of its points over lines in its faces, so that
/// they do not intersect.
void Image::cut(Mesh& mesh, std::array<int, 4> c) const {
  std::sort(c.begin(), c.end(),
            [&](int p, int q) { return label_[p] != label_[q] ? label_[p] < label_[q] : p < q; });
  const int l[4] = {label_[c[0]], label_[c[1]], label_[c[2]], label_[c[3]]};
  auto at = [&](auto... i) { return equal_point({c[i]...}); };
  auto up = [&](int low, int high) { return point(c[low]) - point(c[high]); };
  const int distinct = 1 + (l[0] != l[1]) + (l[1] != l[2]) + (l[2] != l[3]);
  if (distinct == 2 && l[1] == l[2]) {
    const int alone = l[0] != l[1] ? 0 : 3, a = alone ? 0 : 1;
    add_triangle(mesh, {at(alone, a), at(alone, a + 1), at(alone, a + 2)}, alone ? up(0, 3) : up(0, 3));
  } else if (distinct == 2) {
    add_quad(mesh, at(0, 2), at(0, 3), at(1, 3), at(1, 2), up(0, 2) + up(1, 3));
  } else if (distinct == 3) {
    const int a = l[0] == l[1] ? 0 : l[1] == l[2] ? 1 : 2;  // a and a + 1 have one label
    const int b = a == 0 ? 2 : 0, d = a == 2 ? 1 : 3;
    const Vec3 p = at(a, b, d), q = at(a + 1, b, d);
    for (int other : {b, d})
      add_quad(mesh, p, at(a, other), at(a + 1, other), q, other < a ? up(other, a) : up(a, other));
    add_triangle(mesh, {at(b, d), p, q}, up(b, d));
  } else if (distinct == 4) {
    const Vec3 middle = at(0, 1, 2, 3);
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) {
        int k = 0;
        while (k == i || k == j) ++k;
        const int rest = 6 - i - j - k;
        add_quad(mesh, at(i, j), at(i, j, k), middle, at(i, j, rest), up(i, j));
      }
  }
}

/// Adds a triangle of the box's side, cut where sheets end at it.
void Image::cut_side(Mesh& mesh, std::array<int, 3> c, Vec3 up) const {
  std::sort(c.begin(), c.end(),
            [&](int p, int q) { return label_[p] != label_[q] ? label_[p] < label_[q] : p < q; });
  const int l[3] = {label_[c[0]], label_[c[1]], label_[c[2]]};
  const Vec3 p[3] = {point(c[0]), point(c[1]), point(c[2])};
  auto at = [&](auto... i) { return equal_point({c[i]...}); };
  if (l[0] == l[2]) return add_triangle(mesh, {p[0], p[1], p[2]}, up);
  if (l[0] != l[1] && l[1] != l[2]) {
    const Vec3 middle = at(0, 1, 2);
    for (int i = 0; i < 3; ++i) add_quad(mesh, p[i], at(i, (i + 1) % 3), middle, at(i, (i + 2) % 3), up);
    return;
  }
  const int alone = l[0] != l[1] ? 0 : 2, a = alone ? 0 : 1;
  add_triangle(mesh, {p[alone], at(alone, a), at(alone, a + 1)}, up);
  add_quad(mesh, at(alone, a), at(alone, a + 1), p[a + 1], p[a], up);
}

Mesh Image::smooth() const {
  constexpr int paths[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};  // from corner 0 to 7 (Kuhn)
  Mesh mesh;
  auto corner = [&](int i, int j, int k, int c) { return at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)); };
  for (int k = 0; k < n_; ++k)
    for (int j = 0; j < n_; ++j)
      for (int i = 0; i < n_; ++i) {
        for (const auto& [a, b] : paths)
          cut(mesh, {corner(i, j, k, 0), corner(i, j, k, a), corner(i, j, k, b), corner(i, j, k, 7)});
        const int place[3] = {i, j, k};
        for (int axis = 0; axis < 3 && !ball_; ++axis)
          for (int far : {0, 1}) {
            if (place[axis] != far * (n_ - 1)) continue;
            const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, first = far << axis;
            Vec3 up;
            (axis == 0 ? up.x : axis == 1 ? up.y : up.z) = far ? 1 : -1;
            for (int side : {u, v})
              cut_side(
                  mesh,
                  {corner(i, j, k, first), corner(i, j, k, first | side), corner(i, j, k, first | u | v)},
                  up);
          }
      }
  weld(mesh);
  return mesh;
}

/// The squares between voxels of different labels, around the grid's points.
Mesh Image::blocks() const {
  Mesh mesh;
  auto label = [&](int i, int j, int k) {
    const bool within = i >= 0 && j >= 0 && k >= 0 && i <= n_ && j <= n_ && k <= n_;
    return within ? label_[at(i, j, k)] : 0;
  };
  for (int k = -1; k <= n_; ++k)
    for (int j = -1; j <= n_; ++j)
      for (int i = -1; i <= n_; ++i)
        for (int axis = 0; axis < 3; ++axis) {
          const int a = label(i, j, k), b = label(i + (axis == 0), j + (axis == 1), k + (axis == 2));
          if (a == b) continue;
          int p[3] = {i, j, k};
          ++p[axis];
          std::array<Vec3, 4> q;
          for (int c = 0; c < 4; ++c) {
            int x[3] = {p[0], p[1], p[2]};
            x[(axis + 1) % 3] += c == 1 || c == 2;
            x[(axis + 2) % 3] += c >= 2;
            q[c] = {lo_ + h_ * (x[0] - 0.5), lo_ + h_ * (x[1] - 0.5), lo_ + h_ * (x[2] - 0.5)};
          }
          Vec3 up;
          (axis == 0 ? up.x : axis == 1 ? up.y : up.z) = a < b ? -1 : 1;
          add_quad(mesh, q[0], q[1], q[2], q[3], up);
        }
  weld(mesh);
  return mesh;
}

}  // namespace

Mesh brick(std::array<int, 3> count, int n) {
  const auto& [a, b, c] = count;
  const double squares = (double)a * b * (c + 1) + (double)b * c * (a + 1) + (double)c * a * (b + 1);
  const int q = std::max(1, (int)std::lround(std::sqrt(n / (2 * squares))));
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int layer = 0; layer <= count[axis]; ++layer)
      for (int j = 0; j < q * count[v]; ++j)
        for (int i = 0; i < q * count[u]; ++i) {
          std::array<Vec3, 4> p;
          for (int k = 0; k < 4; ++k) {
            double x[3];
            x[axis] = layer;
            x[u] = (double)(i + (k == 1 || k == 2)) / q;
            x[v] = (double)(j + (k >= 2)) / q;
            p[k] = {x[0], x[1], x[2]};
          }
          Vec3 up;
          (axis == 0 ? up.x : axis == 1 ? up.y : up.z) = layer ? 1 : -1;
          add_triangle(mesh, {p[0], p[1], p[2]}, up);
          add_triangle(mesh, {p[0], p[2], p[3]}, up);
        }
  }
  weld(mesh);
  return mesh;
}

Mesh nested_spheres(int count, int n) {
  double area = 0;
  for (int i = 1; i <= count; ++i) area += i * i;
  Mesh mesh;
  for (int i = 1; i <= count; ++i) {
    const Mesh ball = sphere((int)(n * i * i / area));
    const int first = (int)mesh.points.size();
    for (const Vec3& p : ball.points) mesh.points.push_back((double)i / count * p);
    for (const Tri& t : ball.tris) mesh.tris.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return mesh;
}

Mesh labeled_image(int seeds, bool ball, bool blocks, int n, int seed) {
  // a region of volume v has about 5.4 v^(2/3) of surface, half of it shared; a square of the grid that is
  // crossed has about 12 triangles, a voxel's side 2
  const double unit = ball ? 2.6 : 1, area = unit * (5 + 2.7 * std::cbrt(seeds));
  const Image image(seeds, ball, std::sqrt((blocks ? 2.2 : 12) * area / n), seed);
  return blocks ? image.blocks() : image.smooth();
}

}  // namespace meshpipe
