// SPDX-License-Identifier: BSD-3-Clause
// Marching tetrahedra: a cube is cut into the six tetrahedra of its paths from corner 0 to corner 7 (Kuhn),
// which agree on the faces between cubes; a tetrahedron has no ambiguous case, so the surface is a manifold.
#include <algorithm>
#include <stdexcept>

#include "lib/core/error.h"
#include "lib/core/normals.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

// corner c of a cube is at (c & 1, c >> 1 & 1, c >> 2); each row turns right: det(b - a, c - a, d - a) > 0
constexpr int tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                  {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}};

// even permutations that bring corner i, or corners i and j, to the front
constexpr int front[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}};
constexpr int front_pair[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                  {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};

constexpr int block = 8;             // cubes along a block
constexpr double most_points = 1e8;  // of a slice: 7 GB
constexpr double most_cubes = 1e12;  // of the grid: f is asked once per block, which takes minutes

class Marcher {
 public:
  Marcher(const Implicit& f, Vec3 lo, Vec3 hi, int n) : f_(f), lo_(lo) {
    const Vec3 size = hi - lo;
    h_ = std::max({size.x, size.y, size.z}) / n;
    auto cells = [&](double length) { return std::max(1, (int)std::ceil(length / h_ - 1e-9)); };
    nx_ = cells(size.x);
    ny_ = cells(size.y);
    nz_ = cells(size.z);
    bx_ = (nx_ + block - 1) / block;
    by_ = (ny_ + block - 1) / block;
    const std::size_t points = (std::size_t)(nx_ + 1) * (ny_ + 1);
    for (int s = 0; s < 2; ++s) {
      value_[s].assign(points, unknown);
      flat_[s].resize(points);
    }
    steep_.resize(points);
    active_.resize((std::size_t)bx_ * by_);
  }

  Mesh run() {
    for (int k = 0; k < nz_; ++k) {
      if (k % block == 0) {
        find_active(k);
        fill(0, k);
        if (k == 0) cut_edges(0, 0, {1, 2, 3}, flat_[0]);
      }
      std::fill(value_[1].begin(), value_[1].end(), unknown);
      fill(1, k + 1);
      cut_edges(1, k + 1, {1, 2, 3}, flat_[1]);
      cut_edges(0, k, {4, 5, 6, 7}, steep_);
      add_triangles();
      std::swap(value_[0], value_[1]);
      std::swap(flat_[0], flat_[1]);
    }
    return std::move(mesh_);
  }

 private:
  static constexpr double unknown = infinity;

  std::size_t at(int i, int j) const { return (std::size_t)j * (nx_ + 1) + i; }
  Vec3 point(int i, int j, int k) const { return lo_ + Vec3{i * h_, j * h_, k * h_}; }

  /// Which blocks of the layer that starts at slice k the surface may pass through.
  void find_active(int k) {
    const double reach = std::sqrt(3) / 2 * block * h_ * (1 + 1e-9);
#pragma omp parallel for schedule(dynamic)
    for (int b = 0; b < bx_ * by_; ++b) {
      const double half = block / 2.0;
      const Vec3 center = lo_ + h_ * Vec3{b % bx_ * block + half, b / bx_ * block + half, k + half};
      active_[b] = std::abs(f_(center)) <= reach;
    }
  }

  /// Calls visit(i, j) for the points of row j in active blocks; `closed` counts the blocks' far faces in.
  template <class Visit>
  void along_row(int j, bool closed, Visit&& visit) const {
    const int row = j / block, before = closed && j % block == 0 ? row - 1 : row;
    auto is_active = [&](int b) {
      return (row < by_ && active_[(std::size_t)row * bx_ + b]) ||
             (before >= 0 && active_[(std::size_t)before * bx_ + b]);
    };
    for (int b = 0; b < bx_; ++b) {
      if (!is_active(b)) continue;
      const int end = std::min(nx_, (b + 1) * block);
      const bool last = b + 1 == bx_ || !is_active(b + 1);
      for (int i = b * block; i < end + (closed && last); ++i) visit(i, j);
    }
  }

  /// The values of slice k at the points of active blocks that are not there yet.
  void fill(int s, int k) {
#pragma omp parallel for schedule(dynamic)
    for (int j = 0; j <= ny_; ++j)
      along_row(j, true, [&](int i, int j) {
        double& v = value_[s][at(i, j)];
        if (v == unknown) v = f_(point(i, j, k));
      });
  }

  /// A vertex on every edge that changes sign, from the points of slice k in direction d (bits as the
  /// corners').
  void cut_edges(int s, int k, std::initializer_list<int> directions,
                 std::vector<std::array<int, 4>>& edges) {
    for (int j = 0; j <= ny_; ++j)
      along_row(j, true, [&](int i, int j) {
        const double a = value_[s][at(i, j)];
        for (int d : directions) {
          const int x = i + (d & 1), y = j + (d >> 1 & 1);
          if (x > nx_ || y > ny_) continue;
          const double b = value_[s + (d >> 2)][at(x, y)];
          if (b == unknown || (a < 0) == (b < 0)) continue;
          // kept off the grid's points: no slivers, no two vertices in one place
          const double t = std::clamp(a / (a - b), 0.12, 0.88);
          edges[at(i, j)][d % 4] = (int)mesh_.points.size();
          mesh_.points.push_back(lerp(point(i, j, k), point(x, y, k + (d >> 2)), t));
        }
      });
  }

  void add_triangles() {
    for (int j = 0; j < ny_; ++j)
      along_row(j, false, [&](int i, int j) {
        double value[8];
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
          value[c] = value_[c >> 2][at(i + (c & 1), j + (c >> 1 & 1))];
          inside |= (value[c] < 0) << c;
        }
        if (inside == 0 || inside == 255) return;
        for (const auto& tetrahedron : tetrahedra) cut_tetrahedron(i, j, tetrahedron, inside);
      });
  }

  /// The vertex on the edge between two corners of a cube; one is on the way from 0 to the other.
  int vertex(int i, int j, int a, int b) const {
    const int from = std::min(a, b), d = a ^ b;
    const std::size_t p = at(i + (from & 1), j + (from >> 1 & 1));
    return d < 4 ? flat_[from >> 2][p][d] : steep_[p][d % 4];
  }

  void cut_tetrahedron(int i, int j, const int (&corner)[4], int inside) {
    int mask = 0, count = 0;
    for (int c = 0; c < 4; ++c)
      if (inside >> corner[c] & 1) {
        mask |= 1 << c;
        ++count;
      }
    auto v = [&](int a, int b) { return vertex(i, j, corner[a], corner[b]); };
    if (count == 1 || count == 3) {
      const int alone = count == 1 ? mask : 15 ^ mask;
      const auto& p = front[alone == 1 ? 0 : alone == 2 ? 1 : alone == 4 ? 2 : 3];
      Tri t{v(p[0], p[1]), v(p[0], p[2]), v(p[0], p[3])};
      if (count == 3) std::swap(t[1], t[2]);
      mesh_.tris.push_back(t);
    } else if (count == 2) {
      for (const auto& p : front_pair)
        if (mask == (1 << p[0] | 1 << p[1])) {
          const int q[4] = {v(p[0], p[2]), v(p[0], p[3]), v(p[1], p[3]), v(p[1], p[2])};
          const auto& x = mesh_.points;
          const bool even = norm(x[q[0]] - x[q[2]]) <= norm(x[q[1]] - x[q[3]]);
          mesh_.tris.push_back(even ? Tri{q[0], q[1], q[2]} : Tri{q[1], q[2], q[3]});
          mesh_.tris.push_back(even ? Tri{q[0], q[2], q[3]} : Tri{q[1], q[3], q[0]});
        }
    }
  }

  const Implicit& f_;
  Vec3 lo_;
  double h_;
  int nx_, ny_, nz_, bx_, by_;
  std::vector<double> value_[2];             ///< of the lower and the upper slice
  std::vector<std::array<int, 4>> flat_[2];  ///< vertices on edges within the slices, by direction 1, 2, 3
  std::vector<std::array<int, 4>> steep_;    ///< and between them, by direction 4..7
  std::vector<char> active_;
  Mesh mesh_;
};

}  // namespace

Mesh march(const Implicit& f, Vec3 lo, Vec3 hi, int n) {
  if (n < 1 || !(hi.x > lo.x && hi.y > lo.y && hi.z > lo.z)) throw std::logic_error("march: empty grid");
  const Vec3 size = hi - lo;
  const double side = std::max({size.x, size.y, size.z}) / n, slice = size.x * size.y / (side * side);
  if (slice > most_points || slice * size.z / side > most_cubes)
    throw GoalMissed("a grid of " + shown(slice) + " cubes in " + shown(size.z / side) +
                     " slices is too large; ask for fewer triangles or for radii that differ less");
  return Marcher(f, lo, hi, n).run();
}

void relax_on(Mesh& mesh, const Implicit& f, int rounds) {
  const int n = (int)mesh.points.size();
  const std::vector<int> opposite = opposite_halfedges(mesh.tris, n);
  std::vector<Vec3> sum(n);
  std::vector<double> weight(n);
  std::vector<Vec3> plane(n);  // of the border through a vertex, from its neighbors on it
  std::vector<char> border(n, 0);
  for (std::size_t h = 0; h < opposite.size(); ++h)
    if (opposite[h] < 0) border[origin(mesh.tris, (int)h)] = 1;
  const auto loops = boundary_loops(opposite);
  for (const auto& loop : loops) {
    Vec3 area;
    for (int h : loop)
      area = area + cross(mesh.points[origin(mesh.tris, h)] - mesh.points[origin(mesh.tris, loop[0])],
                          mesh.points[target(mesh.tris, h)] - mesh.points[origin(mesh.tris, loop[0])]);
    for (int h : loop) plane[origin(mesh.tris, h)] = normalized(area);
  }
  for (int round = 0; round < rounds; ++round) {
    std::fill(sum.begin(), sum.end(), Vec3{});
    const std::vector<Vec3> normal = vertex_area_vectors(mesh);
    std::fill(weight.begin(), weight.end(), 0);
    for (std::size_t h = 0; h < opposite.size(); ++h) {
      const int a = origin(mesh.tris, (int)h), b = target(mesh.tris, (int)h);
      for (auto [v, w] : {std::pair{a, b}, std::pair{b, a}})
        if (!border[v] || opposite[h] < 0) {
          sum[v] = sum[v] + mesh.points[w];
          weight[v] += 1;
        }
    }
#pragma omp parallel for schedule(static)
    for (int v = 0; v < n; ++v) {
      if (weight[v] == 0) continue;
      Vec3& p = mesh.points[v];
      Vec3 up = normalized(normal[v]);
      Vec3 step = (1 / weight[v]) * sum[v] - p;
      if (border[v]) {
        up = normalized(up - dot(up, plane[v]) * plane[v]);
        step = step - dot(step, plane[v]) * plane[v];
      }
      p = p + 0.8 * (step - dot(step, up) * up);
      const double before = f(p);
      const Vec3 q = p - before * up;
      // thin triangles of a border may show another way than that to the surface
      if (!border[v] || std::abs(f(q)) <= std::abs(before)) p = q;
    }
  }
}

}  // namespace meshpipe
