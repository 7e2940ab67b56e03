// SPDX-License-Identifier: BSD-3-Clause
#include "lib/numeric/multigrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
template <int N>
Eigen::Matrix<double, N, 1> product(const Matrix& a, int from, int to,
                                    const Eigen::Matrix<double, N, Eigen::Dynamic>& x) {
  Eigen::Matrix<double, N, 1> sum = Eigen::Matrix<double, N, 1>::Zero();
  for (int k = from; k < to; ++k) sum += values(a)[k] * x.col(columns(a)[k]);
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
template <int N>
void Multigrid::cycle(std::size_t at, const Vectors<N>& b, Vectors<N>& x) const {
  const Level& level = levels_[at];
  const Matrix &a = level.matrix, &p = level.prolongation;
  const int n = (int)a.rows();
  const std::vector<int>& diagonal = level.diagonal;
  x.resize(N, n);
  if (at + 1 == levels_.size()) {
    for (int c = 0; c < N; ++c) {
      std::vector<double> column(n);
      Eigen::Map<Eigen::RowVectorXd>(column.data(), n) = b.row(c);
      coarsest_->solve(column);
      x.row(c) = Eigen::Map<Eigen::RowVectorXd>(column.data(), n);
    }
    return;
  }
  // A sweep of Gauss and Seidel from zero meets the lower triangle only; what then is left of the right-hand
  // side is the upper triangle's part.
  for (int i = 0; i < n; ++i)
    x.col(i) = (b.col(i) - product<N>(a, rows(a)[i], diagonal[i], x)) / values(a)[diagonal[i]];
  Vectors<N> coarse_b = Vectors<N>::Zero(N, p.cols()), coarse_x;
  for (int i = 0; i < n; ++i) {
    const Eigen::Matrix<double, N, 1> left = -product<N>(a, diagonal[i] + 1, rows(a)[i + 1], x);
    for (int k = rows(p)[i]; k < rows(p)[i + 1]; ++k) coarse_b.col(columns(p)[k]) += values(p)[k] * left;
  }
  cycle<N>(at + 1, coarse_b, coarse_x);
  for (int i = 0; i < n; ++i) x.col(i) += product<N>(p, rows(p)[i], rows(p)[i + 1], coarse_x);
  for (int i = n - 1; i >= 0; --i)
    x.col(i) = (b.col(i) - product<N>(a, rows(a)[i], diagonal[i], x) -
                product<N>(a, diagonal[i] + 1, rows(a)[i + 1], x)) /
               values(a)[diagonal[i]];
}

/// Conjugate gradients for N systems side by side: their steps are their own, but the cycles, most of the
/// work, take the time of one, since they wait for memory and for the unknown before.
template <int N>
bool Multigrid::solve_together(const double* right_hand_side, double* solution) const {
  const Eigen::Index n = matrix().rows();
  struct System {
    Eigen::VectorXd x, residual, direction, image;
    double square = 0, limit = 0, along = 0;
    bool done = false;
  };
  std::array<System, N> systems;
  Vectors<N> together(N, n), cycled;
  auto precondition = [&] {
    for (int c = 0; c < N; ++c) together.row(c) = systems[c].residual.transpose();
    cycle<N>(0, together, cycled);
  };
  for (int c = 0; c < N; ++c) {
    System& s = systems[c];
    s.residual = Eigen::Map<const Eigen::VectorXd>(right_hand_side + c * n, n);
    s.x = Eigen::VectorXd::Zero(n);
    s.square = s.residual.squaredNorm();
    s.limit = std::max(small_residual * small_residual * s.square, std::numeric_limits<double>::min());
    s.done = s.square < s.limit;
  }
  auto left = [&] { return !std::all_of(systems.begin(), systems.end(), [](auto& s) { return s.done; }); };
  for (int step = 0; step < most_steps && left(); ++step) {
    precondition();
    for (int c = 0; c < N; ++c) {
      System& s = systems[c];
      if (s.done) continue;
      const Eigen::VectorXd z = cycled.row(c).transpose();
      const double before = s.along;
      s.along = s.residual.dot(z);
      if (step == 0)
        s.direction = z;
      else
        s.direction = z + s.along / before * s.direction;
      s.image.noalias() = matrix() * s.direction;
      const double length = s.along / s.direction.dot(s.image);
      s.x += length * s.direction;
      s.residual -= length * s.image;
      s.square = s.residual.squaredNorm();
      s.done = s.square < s.limit;
    }
  }
  for (int c = 0; c < N; ++c) {
    const System& s = systems[c];
    const Eigen::Map<const Eigen::VectorXd> b(right_hand_side + c * n, n);
    // what the steps have summed up parts from the residual where the matrix is badly conditioned
    if (!s.done || !((matrix() * s.x - b).norm() <= true_residual * b.norm())) return false;
    Eigen::Map<Eigen::VectorXd>(solution + c * n, n) = s.x;
  }
  return true;
}

bool Multigrid::solve(std::vector<double>& right_hand_side) const {
  const std::size_t n = matrix().rows();
  std::vector<double> solution(right_hand_side.size());
  for (std::size_t at = 0; at < solution.size();) {
    const bool two = at + 2 * n <= solution.size();
    if (!(two ? solve_together<2>(&right_hand_side[at], &solution[at])
              : solve_together<1>(&right_hand_side[at], &solution[at])))
      return false;
    at += two ? 2 * n : n;
  }
  right_hand_side = std::move(solution);
  return true;
}

}  // namespace meshpipe
