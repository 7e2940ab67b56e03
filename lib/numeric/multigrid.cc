// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/multigrid.h"

#include <algorithm>
#include <cmath>

namespace meshpipe {
namespace {

using Matrix = Multigrid::Matrix;

constexpr int most_steps = 60;  // some 18 are usual
constexpr double small_residual = 1e-12, true_residual = 1e-10;
constexpr int few_unknowns = 3000;  // of the level that is factored

/// The entries of row i are rows(m)[i] to rows(m)[i + 1] of columns(m) and values(m).
const int* rows(const Matrix& m) { return m.outerIndexPtr(); }
const int* columns(const Matrix& m) { return m.innerIndexPtr(); }
const double* values(const Matrix& m) { return m.valuePtr(); }

/// Marks the entries off the diagonal with |a_ij| above `threshold` sqrt(a_ii a_jj).
std::vector<char> strong_entries(const Matrix& a, double threshold) {
  const Eigen::VectorXd diagonal = a.diagonal();
  std::vector<char> strong(a.nonZeros());
  for (int i = 0; i < a.rows(); ++i)
    for (int k = rows(a)[i]; k < rows(a)[i + 1]; ++k) {
      const int j = columns(a)[k];
      const double value = values(a)[k] / threshold;
      strong[k] = j != i && value * value > diagonal[i] * diagonal[j];
    }
  return strong;
}

/// Groups of unknowns, each a neighborhood of strong entries (Vanek and others, Algorithm 5.1). Returns
/// their number.
int aggregate(const Matrix& a, const std::vector<char>& strong, std::vector<int>& group) {
  const int n = (int)a.rows();
  int n_groups = 0;
  group.assign(n, -1);
  for (int i = 0; i < n; ++i) {  // whole neighborhoods that are free
    bool free = group[i] < 0;
    for (int k = rows(a)[i]; k < rows(a)[i + 1] && free; ++k) free = !strong[k] || group[columns(a)[k]] < 0;
    if (!free) continue;
    group[i] = n_groups++;
    for (int k = rows(a)[i]; k < rows(a)[i + 1]; ++k)
      if (strong[k]) group[columns(a)[k]] = group[i];
  }
  std::vector<int> joined = group;
  for (int i = 0; i < n; ++i) {  // the others join the group they are coupled to most
    double most = 0;
    for (int k = rows(a)[i]; k < rows(a)[i + 1] && group[i] < 0; ++k)
      if (strong[k] && group[columns(a)[k]] >= 0 && std::abs(values(a)[k]) > most) {
        most = std::abs(values(a)[k]);
        joined[i] = group[columns(a)[k]];
      }
  }
  group.swap(joined);
  for (int i = 0; i < n; ++i) {  // what is left, with its neighbors that are left
    if (group[i] >= 0) continue;
    group[i] = n_groups++;
    for (int k = rows(a)[i]; k < rows(a)[i + 1]; ++k)
      if (strong[k] && group[columns(a)[k]] < 0) group[columns(a)[k]] = group[i];
  }
  return n_groups;
}

/// One on every group, smoothed by a damped Jacobi step of the matrix without its weak entries, which are
/// added to the diagonal: (I - 2/3 D^-1 A) P.
Matrix prolongation(const Matrix& a, double threshold) {
  const std::vector<char> strong = strong_entries(a, threshold);
  std::vector<int> group;
  const int n = (int)a.rows(), n_groups = aggregate(a, strong, group);
  std::vector<int> row(1, 0), column;
  std::vector<double> value;
  for (int i = 0; i < n; ++i) {
    double diagonal = 0, coupling = 0;
    for (int k = rows(a)[i]; k < rows(a)[i + 1]; ++k)
      (strong[k] ? coupling : diagonal) += strong[k] ? std::abs(values(a)[k]) : values(a)[k];
    // a diagonal that dominates bounds the eigenvalues of D^-1 A by 2
    const double step = 2.0 / 3 / std::max(diagonal, coupling);
    auto add = [&](int g, double w) {
      std::size_t k = row[i];
      while (k < column.size() && column[k] != g) ++k;
      if (k == column.size()) {
        column.push_back(g);
        value.push_back(0);
      }
      value[k] += w;
    };
    add(group[i], coupling > 0 ? 1 - step * diagonal : 1);
    for (int k = rows(a)[i]; k < rows(a)[i + 1]; ++k)
      if (strong[k]) add(group[columns(a)[k]], -step * values(a)[k]);
    row.push_back((int)column.size());
  }
  return Eigen::Map<Matrix>(n, n_groups, row.back(), row.data(), column.data(), value.data());
}

/// The part of A x in one row that the entries `from` to `to` are.
double product(const Matrix& a, int from, int to, const Eigen::VectorXd& x) {
  double sum = 0;
  for (int k = from; k < to; ++k) sum += values(a)[k] * x[columns(a)[k]];
  return sum;
}

}  // namespace

Multigrid::Multigrid(Matrix matrix) {
  levels_.reserve(32);  // the matrices are not to be copied
  // the coarser a level, the denser and the more even its entries (Vanek and others, eq. 5.1)
  for (double threshold = 0.08;; threshold /= 2) {
    Level& level = levels_.emplace_back();
    level.matrix.swap(matrix);
    const Matrix& a = level.matrix;
    const int n = (int)a.rows();
    for (int i = 0; i < n; ++i)
      level.diagonal.push_back(
          (int)(std::lower_bound(columns(a) + rows(a)[i], columns(a) + rows(a)[i + 1], i) - columns(a)));
    if (n <= few_unknowns) break;
    Matrix p = prolongation(a, threshold);
    if (p.cols() > n / 2) break;
    const Matrix restricted = p.transpose(), smooth = a * p;
    matrix = restricted * smooth;
    level.prolongation.swap(p);
  }
  const Matrix& a = levels_.back().matrix;
  std::vector<Entry<double>> lower;
  for (int i = 0; i < a.rows(); ++i)
    for (int k = rows(a)[i]; k <= levels_.back().diagonal[i]; ++k)
      lower.push_back({i, columns(a)[k], values(a)[k]});
  coarsest_.emplace((int)a.rows(), std::move(lower));
}

/// An approximate solution by one V-cycle; symmetric in its effect, as conjugate gradients need it.
void Multigrid::cycle(std::size_t at, const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  const Level& level = levels_[at];
  const Matrix &a = level.matrix, &p = level.prolongation;
  const int n = (int)a.rows();
  const std::vector<int>& diagonal = level.diagonal;
  if (at + 1 == levels_.size()) {
    std::vector<double> column(b.begin(), b.end());
    coarsest_->solve(column);
    x = Eigen::Map<Eigen::VectorXd>(column.data(), n);
    return;
  }
  // A sweep of Gauss and Seidel from zero meets the lower triangle only; what then is left of the right-hand
  // side is the upper triangle's part.
  x.resize(n);
  for (int i = 0; i < n; ++i) x[i] = (b[i] - product(a, rows(a)[i], diagonal[i], x)) / values(a)[diagonal[i]];
  Eigen::VectorXd coarse_b = Eigen::VectorXd::Zero(p.cols()), coarse_x;
  for (int i = 0; i < n; ++i) {
    const double left = -product(a, diagonal[i] + 1, rows(a)[i + 1], x);
    for (int k = rows(p)[i]; k < rows(p)[i + 1]; ++k) coarse_b[columns(p)[k]] += values(p)[k] * left;
  }
  cycle(at + 1, coarse_b, coarse_x);
  for (int i = 0; i < n; ++i) x[i] += product(p, rows(p)[i], rows(p)[i + 1], coarse_x);
  for (int i = n - 1; i >= 0; --i)
    x[i] = (b[i] - product(a, rows(a)[i], diagonal[i], x) - product(a, diagonal[i] + 1, rows(a)[i + 1], x)) /
           values(a)[diagonal[i]];
}

/// A V-cycle as Eigen's solvers take a preconditioner.
struct Multigrid::Cycle {
  const Multigrid* of = nullptr;
  template <class AnyMatrix>
  Cycle& compute(const AnyMatrix&) {
    return *this;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const {
    Eigen::VectorXd x;
    of->cycle(0, b, x);
    return x;
  }
  Eigen::ComputationInfo info() const { return Eigen::Success; }
};

bool Multigrid::solve(std::vector<double>& right_hand_side) const {
  const Eigen::Index n = matrix().rows();
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper, Cycle> steps;
  steps.preconditioner().of = this;
  steps.compute(matrix()).setTolerance(small_residual).setMaxIterations(most_steps);
  std::vector<double> solution(right_hand_side.size());
  for (std::size_t at = 0; at < solution.size(); at += n) {
    const Eigen::Map<const Eigen::VectorXd> b(&right_hand_side[at], n);
    Eigen::Map<Eigen::VectorXd> x(&solution[at], n);
    x = steps.solve(b);
    // what the steps have summed up parts from the residual where the matrix is badly conditioned
    if (steps.info() != Eigen::Success || !((matrix() * x - b).norm() <= true_residual * b.norm()))
      return false;
  }
  right_hand_side = std::move(solution);
  return true;
}

}  // namespace meshpipe
