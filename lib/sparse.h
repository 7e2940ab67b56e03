// SPDX-License-Identifier: BSD-3-Clause
// Sparse solves, by Eigen's simplicial LDL^T or by multigrid.
#pragma once
#include <array>
#include <complex>
#include <memory>
#include <vector>

#include "lib/vec.h"

namespace meshpipe {

/// An entry of a matrix; entries at the same place add up. Give the lower triangle (row >= col) only.
template <class Scalar>
struct Entry {
  int row, col;
  Scalar value;
};

/// Where the wall time of sparse solves goes, in seconds.
struct SolveTime {
  double ordering = 0;                  ///< with the symbolic factorisation
  double factorisation = 0, solve = 0;  ///< multigrid: its levels, its steps
};

/// What is known of a matrix: a Laplacian, with some values held or masses added, can be solved by multigrid.
enum class MatrixKind { any, laplacian };

/// A factorised symmetric (real) or Hermitian (complex) positive definite matrix of n rows.
/// The constructor throws GoalMissed if the matrix is numerically singular or holds NaN.
/// Order: approximate minimum degree. `time`, if given, is added to, and has to outlive the factorisation.
/// A real matrix of kind `laplacian` whose order shows that multigrid (lib/multigrid.h) is faster, as it is
/// for large round charts and not for long or branched ones, is factorised only if that does not converge.
template <class Scalar>
class Factorisation {
 public:
  Factorisation(int n, std::vector<Entry<Scalar>> lower_triangle, SolveTime* time = nullptr,
                MatrixKind kind = MatrixKind::any);
  ~Factorisation();
  Factorisation(Factorisation&&) noexcept;
  /// Another matrix in the order of the first, whose places have to be the same. Throws like the constructor.
  /// Precondition: kind `any`.
  void refactor(const std::vector<Entry<Scalar>>& lower_triangle);
  /// Solves in place; call as often as needed, one call at a time. Several right-hand sides of n numbers each
  /// follow each other. Throws GoalMissed if the solution is beyond doubles, and like the constructor if
  /// multigrid does not converge and the factorisation is made now.
  void solve(std::vector<Scalar>& right_hand_side) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Weights w of the triangle's edges for the operator sum_j w_ij (u_i - u_j): half the cotangent of the angle
/// opposite to edge i -> i+1 (i.e. at corner i+2). `floor`, relative: cotangents below it are raised to it,
/// which keeps the operator an M-matrix (floor > 0 gives a one-to-one map on a convex border, Floater 1997).
/// Degenerate triangles get finite weights (lengths are mollified).
std::array<double, 3> cotangent_weights(Vec3 a, Vec3 b, Vec3 c, double floor = -1e30);

/// Solves A x = b in place for a square matrix of n rows without symmetry (all entries given; equal places
/// add up); right-hand sides of n numbers each follow each other. Throws GoalMissed if the matrix is
/// singular.
void solve_unsymmetric(int n, const std::vector<Entry<double>>& entries, std::vector<double>& right_hand_side,
                       SolveTime* time = nullptr);

/// Dirichlet problem for the graph Laplacian of a triangle mesh: minimises sum w_ij |u_i - u_j|^2 with the
/// values at `fixed` vertices (fixed[v] != 0) held. `uv` holds the fixed values on entry and all values on
/// return. weights[h] is the weight of half-edge h's triangle on its edge (summed over the triangles of an
/// edge); one factorisation, both coordinates solved with it. Vertices of no triangle stay. Throws GoalMissed
/// if the matrix is singular (a component without a fixed vertex).
void solve_dirichlet(const std::vector<std::array<int, 3>>& tris, const std::vector<double>& weights,
                     const std::vector<char>& fixed, std::vector<Vec2>& uv, SolveTime* time = nullptr);

}  // namespace meshpipe
