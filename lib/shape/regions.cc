// SPDX-License-Identifier: BSD-3-Clause
// Surfaces that divide space into many regions: bricks, nested spheres, and Voronoi diagrams as labeled
// images have them, as the sides of voxels or as surface nets: Gibson, "Constrained elastic surface nets",
// 1998. These have the vertices of the former, moved so that sheets and lines are smooth.
#include <algorithm>
#include <array>

#include "lib/core/connectivity.h"
#include "lib/core/random.h"
#include "lib/core/weld.h"
#include "lib/shape/shape.h"
#include "lib/smooth/smooth.h"

namespace meshpipe {
namespace {

/// Appends the square across an axis whose lowest corner is this one of a grid, as two triangles on points of
/// their own; `up`: its normal is along the axis.
template <class Point>
void add_square(Mesh& mesh, const std::array<int, 3>& lowest, int axis, bool up, const Point& point) {
  constexpr int order[2][6] = {{0, 2, 1, 0, 3, 2}, {0, 1, 2, 0, 2, 3}};
  const int first = (int)mesh.points.size();
  for (int corner : order[up]) {
    std::array<int, 3> x = lowest;
    x[(axis + 1) % 3] += corner == 1 || corner == 2;
    x[(axis + 2) % 3] += corner >= 2;
    mesh.points.push_back(point(x));
  }
  for (int v : {first, first + 3}) mesh.tris.push_back({v, v + 1, v + 2});
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
  bool inside(int x) const { return x >= 0 && x <= n_; }
  int label(int i, int j, int k) const {
    return inside(i) && inside(j) && inside(k) ? label_[at(i, j, k)] : 0;
  }

  bool ball_;
  int n_;
  double h_, lo_;
  std::vector<Vec3> seeds_;
  std::vector<int> label_;
};

int Image::label_at(Vec3 p) const {
  if (ball_ && norm(p) > 1) return 0;
  int best = 0;
  double least = infinity;
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

/// The squares between voxels of different labels, around the grid's points.
Mesh Image::blocks() const {
  Mesh mesh;
  for (int k = -1; k <= n_; ++k)
    for (int j = -1; j <= n_; ++j)
      for (int i = -1; i <= n_; ++i)
        for (int axis = 0; axis < 3; ++axis) {
          const int a = label(i, j, k), b = label(i + (axis == 0), j + (axis == 1), k + (axis == 2));
          if (a == b) continue;
          std::array<int, 3> p{i, j, k};
          ++p[axis];
          add_square(mesh, p, axis, a > b, [&](const std::array<int, 3>& x) {
            return Vec3{lo_ + h_ * (x[0] - 0.5), lo_ + h_ * (x[1] - 0.5), lo_ + h_ * (x[2] - 0.5)};
          });
        }
  weld(mesh);
  return mesh;
}

Mesh Image::smooth() const {
  Surface nets = surface_of(blocks());
  flip_ears(nets);
  for (int i = 0; i < 2; ++i) smooth_sheets(nets, {});  // once leaves waves where sheets are along the grid
  return nets;
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
          std::array<int, 3> p;
          p[axis] = q * layer, p[u] = i, p[v] = j;
          add_square(mesh, p, axis, layer > 0, [&](const std::array<int, 3>& x) {
            return Vec3{(double)x[0] / q, (double)x[1] / q, (double)x[2] / q};
          });
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
  // a region of volume v has about 5.4 v^(2/3) of surface, half of it shared; a voxel's side has 2 triangles
  const double unit = ball ? 2.6 : 1, area = unit * (5 + 2.7 * std::cbrt(seeds));
  const Image image(seeds, ball, std::sqrt(2.2 * area / n), seed);
  return blocks ? image.blocks() : image.smooth();
}

}  // namespace meshpipe
