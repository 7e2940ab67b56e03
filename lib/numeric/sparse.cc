// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/sparse.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <limits>
#include <string>
#include <utility>

#include "lib/core/error.h"
#include "lib/core/number.h"
#include "lib/numeric/multigrid.h"

namespace meshpipe {
namespace {

/// Approximate minimum degree of a matrix with both triangles, which it destroys. Eigen's adds the transpose
/// to it first.
struct MinimumDegree {
  using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
  template <class Matrix>
  void operator()(Matrix& full, PermutationType& order) const {
    Eigen::internal::minimum_degree_ordering(full, order);
  }
};

/// Takes the entries, whose memory a factorization may need.
template <class Scalar>
Eigen::SparseMatrix<Scalar> compress(int n, std::vector<Entry<Scalar>> entries) {
  std::vector<Eigen::Triplet<Scalar>> triplets;
  triplets.reserve(entries.size());
  for (const Entry<Scalar>& e : entries) triplets.emplace_back(e.row, e.col, e.value);
  Eigen::SparseMatrix<Scalar> m(n, n);
  m.setFromTriplets(triplets.begin(), triplets.end());
  return m;
}

template <class Matrix>
void require_finite(const Matrix& x) {
  if (!x.allFinite())
    throw GoalMissed("the solution for " + std::to_string(x.rows()) + " unknowns is not finite");
}

template <class Scalar>
struct Ldlt : Eigen::SimplicialLDLT<Eigen::SparseMatrix<Scalar>, Eigen::Lower, MinimumDegree> {
  /// Multiplications of the numeric factorization, known after the symbolic one.
  double cost() const { return this->m_nonZerosPerCol.template cast<double>().squaredNorm(); }
};

/// Multiplications an unknown above which multigrid is faster: measured from 10^4 to 10^6 triangles.
constexpr double cost_of_multigrid = 5000;

}  // namespace

template <class Scalar>
struct Factorization<Scalar>::Impl {
  Ldlt<Scalar> ldlt;
  int n;
  std::unique_ptr<Multigrid> multigrid;  ///< takes the place of the numeric factorization

  void factorize(const Eigen::SparseMatrix<Scalar>& m) {
    ldlt.factorize(m);
    // Eigen only notices a pivot that is exactly zero (and the later ones are then not set); a pivot that has
    // lost all its digits against the diagonal it started from is as singular, and a negative one as little
    // definite
    const auto& pivot = ldlt.vectorD();
    const auto& order = ldlt.permutationP().indices();
    constexpr double lost = 4 * std::numeric_limits<double>::epsilon();
    for (int i = 0; i < n; ++i) {
      double d = std::real(pivot[order[i]]), a = std::real(m.coeff(i, i));
      if (ldlt.info() != Eigen::Success || !(d > lost * a) || !std::isfinite(d))
        throw GoalMissed("singular matrix of " + std::to_string(n) + " rows: row " + std::to_string(i) +
                         " has diagonal " + shown(a) + " and pivot " + shown(d));
    }
  }
};

template <class Scalar>
Factorization<Scalar>::Factorization(int n, std::vector<Entry<Scalar>> lower_triangle, MatrixKind kind)
    : impl_(std::make_unique<Impl>()) {
  impl_->n = n;
  Eigen::SparseMatrix<Scalar> m = compress(n, std::move(lower_triangle));
  impl_->ldlt.analyzePattern(m);
  if constexpr (std::is_same_v<Scalar, double>) {
    if (kind == MatrixKind::laplacian && impl_->ldlt.cost() > cost_of_multigrid * n) {
      try {
        impl_->multigrid = std::make_unique<Multigrid>(m.template selfadjointView<Eigen::Lower>());
        return;
      } catch (const GoalMissed&) {  // its coarsest level is singular to rounding
      }
    }
  }
  impl_->factorize(m);
}

template <class Scalar>
Factorization<Scalar>::~Factorization() = default;
template <class Scalar>
Factorization<Scalar>::Factorization(Factorization&&) noexcept = default;

template <class Scalar>
void Factorization<Scalar>::refactor(const std::vector<Entry<Scalar>>& lower_triangle) {
  impl_->factorize(compress(impl_->n, lower_triangle));
}

template <class Scalar>
void Factorization<Scalar>::solve(std::vector<Scalar>& right_hand_side) const {
  if (right_hand_side.empty()) return;
  if constexpr (std::is_same_v<Scalar, double>) {
    if (impl_->multigrid && impl_->multigrid->solve(right_hand_side)) return;
    if (impl_->multigrid) impl_->factorize(std::exchange(impl_->multigrid, nullptr)->matrix());
  }
  Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> x(
      right_hand_side.data(), impl_->n, (Eigen::Index)right_hand_side.size() / impl_->n);
  x = impl_->ldlt.solve(x).eval();
  require_finite(x);
}

template class Factorization<double>;
template class Factorization<std::complex<double>>;

void solve_unsymmetric(int n, const std::vector<Entry<double>>& entries,
                       std::vector<double>& right_hand_side) {
  if (n == 0) return;
  Eigen::SparseMatrix<double> m = compress(n, entries);
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> lu;
  lu.analyzePattern(m);
  lu.factorize(m);
  if (lu.info() != Eigen::Success) throw GoalMissed("singular matrix of " + std::to_string(n) + " rows");
  Eigen::Map<Eigen::MatrixXd> x(right_hand_side.data(), n, (Eigen::Index)right_hand_side.size() / n);
  x = lu.solve(x).eval();
  require_finite(x);
}

struct ConjugateGradients::Impl {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Matrix matrix;
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> steps;
};

ConjugateGradients::ConjugateGradients(int n, std::vector<Entry<double>> lower_triangle, double tolerance,
                                       int most_steps)
    : impl_(std::make_unique<Impl>()) {
  impl_->matrix = compress(n, std::move(lower_triangle)).template selfadjointView<Eigen::Lower>();
  impl_->steps.setTolerance(tolerance).setMaxIterations(most_steps).compute(impl_->matrix);
}
ConjugateGradients::~ConjugateGradients() = default;

void ConjugateGradients::solve(const std::vector<double>& right_hand_side, std::vector<double>& x) const {
  const auto n = (Eigen::Index)x.size();
  const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(right_hand_side.data(), n);
  const Eigen::VectorXd guess = Eigen::Map<Eigen::VectorXd>(x.data(), n);
  Eigen::Map<Eigen::VectorXd>(x.data(), n) = impl_->steps.solveWithGuess(b, guess);
}

}  // namespace meshpipe
