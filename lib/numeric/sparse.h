// SPDX-License-Identifier: BSD-3-Clause
// Sparse solves, by Eigen's simplicial LDL^T, multigrid or conjugate gradients.
#pragma once
#include <memory>
#include <vector>

namespace meshpipe {

/// An entry of a matrix; entries at the same place add up.
template <class Scalar>
struct Entry {
  int row, col;
  Scalar value;
};

/// What is known of a matrix. A Laplacian, with some values held or masses added, can be solved by multigrid.
enum class MatrixKind { any, laplacian };

/// A factorized symmetric (real) or Hermitian (complex) positive definite matrix of n rows, ordered by
/// approximate minimum degree. A real matrix of kind `laplacian` whose order shows that multigrid
/// (lib/numeric/multigrid.h) is faster, as for large round charts and not for long or branched ones, is
/// factorized only if that does not converge.
template <class Scalar>
class Factorization {
 public:
  /// Factorizes a matrix, given by the entries with row >= col. `time`, if given, is added to, and must
  /// outlive the object. Throws: GoalMissed if the matrix is numerically singular or holds NaN.
  Factorization(int n, std::vector<Entry<Scalar>> lower_triangle, MatrixKind kind = MatrixKind::any);
  ~Factorization();
  Factorization(Factorization&&) noexcept;
  /// Factorizes another matrix with the same places in the order of the first. Throws: as the constructor.
  /// Requires: kind `any`.
  void refactor(const std::vector<Entry<Scalar>>& lower_triangle);
  /// Solves in place, one call at a time; right-hand sides of n numbers each follow each other. Throws:
  /// GoalMissed if the solution is beyond doubles, and as the constructor if multigrid does not converge and
  /// the matrix is factorized now.
  void solve(std::vector<Scalar>& right_hand_side) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Solves A x = b in place for a square matrix of n rows without symmetry; right-hand sides of n numbers each
/// follow each other. Throws: GoalMissed if the matrix is singular.
void solve_unsymmetric(int n, const std::vector<Entry<double>>& entries,
                       std::vector<double>& right_hand_side);

/// Conjugate gradients, preconditioned by the diagonal, for a symmetric positive definite matrix of n rows,
/// given by the entries with row >= col.
class ConjugateGradients {
 public:
  /// Stops at a residual of `tolerance` relative to the right-hand side, or after `most_steps`.
  ConjugateGradients(int n, std::vector<Entry<double>> lower_triangle, double tolerance, int most_steps);
  ~ConjugateGradients();
  /// Improves the guess x; the residual may stay above the tolerance.
  void solve(const std::vector<double>& right_hand_side, std::vector<double>& x) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshpipe
