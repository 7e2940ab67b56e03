// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multigrid.h"

#include <algorithm>
#include <cmath>

namespace meshpipe {
namespace {

using Matrix = Multigrid::Matrix;

constexpr int most_steps = 60;  // some 18 are usual
constexpr double small_residual = 1e-12, true_residual = 1e-10;
constexpr int few_unknowns = 3000;  // of the level that is factorised

/// The entries of row i are rows(m)[i] to rows(m)[i + 1] of columns(m) and values(m).
const int* rows(const Matrix& m) { return m.outerIndexPtr(); }
const int* columns(const Matrix& m) { return m.innerIndexPtr(); }
const double* values(const Matrix& m) { return m.valuePtr(); }

/// Marks the entries beside the diagonal with |a_ij| above `threshold` sqrt(a_ii a_jj).
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

/// Groups of unknowns, each a neighbourhood of strong entries (Vanek and others, Algorithm 5.1). Returns
/// their number.
int aggregate(const Matrix& a, const std::vector<char>& strong, std::vector<int>& group) {
  const int n = (int)a.rows();
  int n_groups = 0;
  group.assign(n, -1);
  for (int i = 0; i < n; ++i) {  // whole neighbourhoods that are free
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
  for (int i = 0; i < n; ++i) {  // what is left, with its neighbours that are left
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
    double diagonal = 0, beside = 0;
    for (int k = rows(a)[i]; k < rows(a)[i + 1]; ++k)
      (strong[k] ? beside : diagonal) += strong[k] ? std::abs(values(a)[k]) : values(a)[k];
    // a diagonal that dominates bounds the eigenvalues of D^-1 A by 2
    const double step = 2.0 / 3 / std::max(diagonal, beside);
    auto add = [&](int g, double w) {
      std::size_t k = row[i];
      while (k < column.size() && column[k] != g) ++k;
      if (k == column.size()) {
        column.push_back(g);
        value.push_back(0);
      }
      value[k] += w;
    };
    add(group[i], beside > 0 ? 1 - step * diagonal : 1);
    for (int k = rows(a)[i]; k < rows(a)[i + 1]; ++k)
      if (strong[k]) add(group[columns(a)[k]], -step * values(a)[k]);
    row.push_back((int)column.size());
  }
  return Eigen::Map<Matrix>(n, n_groups, row.back(), row.data(), column.data(), value.data());
}

/// Adds factor A x to K sums, over the entries `from` to `to`; x holds K numbers an unknown.
template <int K>
void add_row(const Matrix& a, int from, int to, double factor, const std::vector<double>& x, double* sum) {
  for (int k = from; k < to; ++k) {
    const double w = factor * values(a)[k];
    const double* at = &x[(std::size_t)K * columns(a)[k]];
    for (int c = 0; c < K; ++c) sum[c] += w * at[c];
  }
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
template <int K>
void Multigrid::cycle(std::size_t at, const std::vector<double>& b, std::vector<double>& x) const {
  const Level& level = levels_[at];
  const Matrix &a = level.matrix, &p = level.prolongation;
  const int n = (int)a.rows();
  const std::vector<int>& diagonal = level.diagonal;
  if (at + 1 == levels_.size()) {
    std::vector<double> columns((std::size_t)K * n);
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < K; ++c) columns[(std::size_t)c * n + i] = b[(std::size_t)K * i + c];
    coarsest_->solve(columns);
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < K; ++c) x[(std::size_t)K * i + c] = columns[(std::size_t)c * n + i];
    return;
  }
  // A sweep of Gauss and Seidel from zero meets the lower triangle only; what then is left of the right-hand
  // side is the upper triangle's part.
  for (int i = 0; i < n; ++i) {
    double* s = &x[(std::size_t)K * i];
    std::copy_n(&b[(std::size_t)K * i], K, s);
    double sum[K] = {};
    add_row<K>(a, rows(a)[i], diagonal[i], 1, x, sum);
    for (int c = 0; c < K; ++c) s[c] = (s[c] - sum[c]) / values(a)[diagonal[i]];
  }
  std::vector<double> coarse_b(K * p.cols(), 0), coarse_x(K * p.cols());
  for (int i = 0; i < n; ++i) {
    double left[K] = {};
    add_row<K>(a, diagonal[i] + 1, rows(a)[i + 1], -1, x, left);
    for (int k = rows(p)[i]; k < rows(p)[i + 1]; ++k)
      for (int c = 0; c < K; ++c) coarse_b[(std::size_t)K * columns(p)[k] + c] += values(p)[k] * left[c];
  }
  cycle<K>(at + 1, coarse_b, coarse_x);
  for (int i = 0; i < n; ++i) add_row<K>(p, rows(p)[i], rows(p)[i + 1], 1, coarse_x, &x[(std::size_t)K * i]);
  for (int i = n - 1; i >= 0; --i) {
    double sum[K] = {};
    add_row<K>(a, rows(a)[i], diagonal[i], 1, x, sum);
    add_row<K>(a, diagonal[i] + 1, rows(a)[i + 1], 1, x, sum);
    for (int c = 0; c < K; ++c)
      x[(std::size_t)K * i + c] = (b[(std::size_t)K * i + c] - sum[c]) / values(a)[diagonal[i]];
  }
}

/// K systems side by side, which share the passes over the matrices; each has its own steps.
template <int K>
bool Multigrid::conjugate_gradients(double* columns) const {
  const Matrix& a = matrix();
  const std::size_t n = a.rows();
  std::vector<double> r(K * n), x(K * n, 0), z(K * n), p(K * n, 0), q(K * n);
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < K; ++c) r[K * i + c] = columns[c * n + i];
  auto products = [n](const std::vector<double>& u, const std::vector<double>& v, double* sum) {
    std::fill_n(sum, K, 0.0);
    for (std::size_t i = 0; i < K * n; i += K)
      for (int c = 0; c < K; ++c) sum[c] += u[i + c] * v[i + c];
  };
  double size[K], left[K], rz[K], rz_before[K] = {}, pq[K];
  products(r, r, size);
  for (int step = 0; step < most_steps; ++step) {
    cycle<K>(0, r, z);
    products(r, z, rz);
    for (std::size_t i = 0; i < K * n; i += K)
      for (int c = 0; c < K; ++c)
        p[i + c] = z[i + c] + (rz_before[c] > 0 ? rz[c] / rz_before[c] : 0) * p[i + c];
    std::fill(q.begin(), q.end(), 0);
    for (std::size_t i = 0; i < n; ++i) add_row<K>(a, rows(a)[i], rows(a)[i + 1], 1, p, &q[K * i]);
    products(p, q, pq);
    for (std::size_t i = 0; i < K * n; i += K)
      for (int c = 0; c < K; ++c) {
        const double length = pq[c] > 0 ? rz[c] / pq[c] : 0;
        x[i + c] += length * p[i + c];
        r[i + c] -= length * q[i + c];
      }
    std::copy_n(rz, K, rz_before);
    products(r, r, left);
    bool done = true;
    for (int c = 0; c < K; ++c) done = done && left[c] <= small_residual * small_residual * size[c];
    if (!done) continue;
    // what the steps have summed up parts from the residual where the matrix is badly conditioned
    std::fill(q.begin(), q.end(), 0);
    for (std::size_t i = 0; i < n; ++i) add_row<K>(a, rows(a)[i], rows(a)[i + 1], 1, x, &q[K * i]);
    for (std::size_t i = 0; i < n; ++i)
      for (int c = 0; c < K; ++c) q[K * i + c] -= columns[c * n + i];
    products(q, q, left);
    for (int c = 0; c < K; ++c)
      if (!(left[c] <= true_residual * true_residual * size[c])) return false;
    for (std::size_t i = 0; i < n; ++i)
      for (int c = 0; c < K; ++c) columns[c * n + i] = x[K * i + c];
    return true;
  }
  return false;
}

bool Multigrid::solve(std::vector<double>& right_hand_side) const {
  const std::size_t n = matrix().rows();
  std::vector<double> solution = right_hand_side;
  for (std::size_t at = 0; at < solution.size();) {
    const bool two = at + 2 * n <= solution.size();
    if (!(two ? conjugate_gradients<2>(&solution[at]) : conjugate_gradients<1>(&solution[at]))) return false;
    at += two ? 2 * n : n;
  }
  right_hand_side = std::move(solution);
  return true;
}

}  // namespace meshpipe
