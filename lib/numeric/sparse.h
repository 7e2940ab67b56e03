// SPDX-License-Identifier: BSD-3-Clause
// Sparse solves, by Eigen's simplicial LDL^T, multigrid or conjugate gradients.
#pragma once
#include <complex>
#include <memory>
#include <vector>

namespace meshpipe {

/// An entry of a matrix; entries at the same place add up. Give the lower triangle (row >= col) only.
template <class Scalar>
struct Entry {
  int row, col;
  Scalar value;
};

/// Where the wall time of sparse solves goes, in seconds.
struct SolveTime {
  double ordering = 0;                  ///< with the symbolic factorization
  double factorization = 0, solve = 0;  ///< multigrid: its levels, its steps
};

/// What is known of a matrix: a Laplacian, with some values held or masses added, can be solved by multigrid.
enum class MatrixKind { any, laplacian };

/// A factored symmetric (real) or Hermitian (complex) positive definite matrix of n rows. The constructor
/// throws GoalMissed if the matrix is numerically singular or holds NaN. Order: approximate minimum degree.
/// `time`, if given, is added to, and has to outlive the factorization. A real matrix of kind `laplacian`
/// whose order shows that multigrid (lib/numeric/multigrid.h) is faster, as it is for large round charts and
/// not for long or branched ones, is factored only if that does not converge.
template <class Scalar>
class Factorization {
 public:
  Factorization(int n, std::vector<Entry<Scalar>> lower_triangle, SolveTime* time = nullptr,
                MatrixKind kind = MatrixKind::any);
  ~Factorization();
  Factorization(Factorization&&) noexcept;
  /// Another matrix in the order of the first, whose places have to be the same. Throws like the constructor.
  /// Requires: kind `any`.
  void refactor(const std::vector<Entry<Scalar>>& lower_triangle);
  /// Solves in place; call as often as needed, one call at a time. Several right-hand sides of n numbers each
  /// follow each other. Throws GoalMissed if the solution is beyond doubles, and like the constructor if
  /// multigrid does not converge and the factorization is made now.
  void solve(std::vector<Scalar>& right_hand_side) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Solves A x = b in place for a square matrix of n rows without symmetry (all entries given; equal places
/// add up); right-hand sides of n numbers each follow each other. Throws GoalMissed if the matrix is
/// singular.
void solve_unsymmetric(int n, const std::vector<Entry<double>>& entries, std::vector<double>& right_hand_side,
                       SolveTime* time = nullptr);

/// Conjugate gradients, preconditioned by the diagonal, for a symmetric positive definite matrix of n rows.
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
