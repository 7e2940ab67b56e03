// SPDX-License-Identifier: BSD-3-Clause
// Conjugate gradients preconditioned by algebraic multigrid, for Laplacians that cost too much to factor.
#pragma once
#include <Eigen/IterativeLinearSolvers>
#include <optional>
#include <vector>

#include "lib/numeric/sparse.h"

namespace meshpipe {

/// Smoothed aggregation (Vanek, Mandel and Brezina 1996) of a symmetric positive definite matrix that is
/// nearly a Laplacian: small row sums, few and small positive entries off the diagonal. Time and memory are
/// nearly linear in its entries; a factorization's grow with the power 1.5 of the unknowns of a plane mesh.
class Multigrid {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Takes a matrix with both triangles, the columns of every row in order, compressed. Throws: GoalMissed if
  /// it is singular as far as its coarsest level, which is factorized, tells.
  explicit Multigrid(Matrix matrix);

  /// Returns the matrix.
  const Matrix& matrix() const { return levels_[0].matrix; }

  /// Solves in place; right-hand sides of n numbers each follow each other. Returns false, and changes
  /// nothing, if the residual of one is not below 1e-12 of it, as the steps sum it up, after 60 steps, or not
  /// below 1e-10 in the end.
  bool solve(std::vector<double>& right_hand_side) const;

 private:
  struct Level {
    Matrix matrix;
    std::vector<int> diagonal;  ///< its place in every row
    Matrix prolongation;        ///< from the next coarser level, if there is one
  };
  struct Cycle;
  void cycle(std::size_t level, const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

  std::vector<Level> levels_;
  std::optional<Factorization<double>> coarsest_;
};

}  // namespace meshpipe
