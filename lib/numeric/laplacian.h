// SPDX-License-Identifier: BSD-3-Clause
// Laplacians of weighted graphs and triangle meshes.
#pragma once
#include <algorithm>
#include <array>
#include <utility>

#include "lib/core/vec.h"
#include "lib/numeric/sparse.h"

namespace meshpipe {

/// Returns the weights w of a triangle's edges for the operator sum_j w_ij (u_i - u_j): for edge i -> i+1,
/// half the cotangent of the angle opposite to it. Cotangents below `floor` are raised to it, which keeps the
/// operator an M-matrix (floor > 0 gives a one-to-one map on a convex border, Floater 1997). Degenerate
/// triangles get finite weights (lengths are mollified).
std::array<double, 3> cotangent_weights(Vec3 a, Vec3 b, Vec3 c, double floor = -1e30);

/// The matrix of the sum over edges of w (x_i - x_j)^2, plus a diagonal, while it is assembled.
class Laplacian {
 public:
  /// Starts with rows 0..n-1 and these values on the diagonal.
  explicit Laplacian(std::vector<double> diagonal) : diagonal_(std::move(diagonal)) {}
  explicit Laplacian(int n) : diagonal_(n, 0) {}
  void reserve(std::size_t edges) { entries_.reserve(edges + diagonal_.size()); }
  /// Adds an edge of weight w between rows i and j; -1: an end whose value is held; i == j adds nothing.
  void add_edge(int i, int j, double w) {
    if (i == j) return;
    add_diagonal(i, w);
    add_diagonal(j, w);
    couple(i, j, w);
  }
  /// Adds w to the diagonal; add_edge is this for both ends, and couple.
  void add_diagonal(int i, double w) {
    if (i >= 0) diagonal_[i] += w;
  }
  void couple(int i, int j, double w) {
    if (i >= 0 && j >= 0) entries_.push_back({std::max(i, j), std::min(i, j), -w});
  }
  int rows() const { return (int)diagonal_.size(); }
  /// Returns the entries of the lower triangle, and leaves the object empty.
  std::vector<Entry<double>> lower_triangle();
  /// Factorizes the matrix, and leaves the object empty.
  Factorization<double> factorize(MatrixKind kind = MatrixKind::any) {
    const int n = rows();
    return Factorization<double>(n, lower_triangle(), kind);
  }

 private:
  std::vector<double> diagonal_;
  std::vector<Entry<double>> entries_;
};

/// Solves the Dirichlet problem for the graph Laplacian of a triangle mesh: minimizes sum w_ij |u_i - u_j|^2
/// with the values at `fixed` vertices (fixed[v] != 0) held. `uv` holds the fixed values on entry and all
/// values on return. weights[h]: the weight of half-edge h's triangle on its edge (both triangles add up).
/// Vertices of no triangle stay. Throws: GoalMissed if a component has no fixed vertex.
void solve_dirichlet(const std::vector<std::array<int, 3>>& tris, const std::vector<double>& weights,
                     const std::vector<char>& fixed, std::vector<Vec2>& uv);

}  // namespace meshpipe
