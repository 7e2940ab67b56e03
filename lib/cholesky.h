// SPDX-License-Identifier: BSD-3-Clause
// Sparse Cholesky factorisation by dense fronts: the multifrontal method (Duff and Reid 1983, Liu 1992).
#pragma once
#include <vector>

#include "lib/ordering.h"
#include "lib/sparse.h"

namespace meshpipe {

/// The factor's columns in groups with the same rows below them, where a few zeros stored are worth a longer
/// group. Columns are numbered in the order of elimination, in which every group comes after the groups that
/// its rows depend on (a postorder of the elimination tree).
struct Supernodes {
  std::vector<int> order;      ///< row of the matrix that is eliminated k-th
  std::vector<int> place;      ///< its inverse
  std::vector<int> first;      ///< columns first[s] .. first[s + 1] are group s
  std::vector<int> row_start;  ///< rows[row_start[s] .. row_start[s + 1]): those below group s, ascending
  std::vector<int> rows;
  std::vector<int> child_start, child;   ///< groups whose first row is a column of s, ascending
  std::vector<std::size_t> value_start;  ///< of the group's block in the factor, columns one after the other
  std::size_t most_waiting = 0;          ///< values of updates that wait for their parent at any one time

  int size() const { return (int)first.size() - 1; }
  int width(int s) const { return first[s + 1] - first[s]; }
  int below(int s) const { return row_start[s + 1] - row_start[s]; }
};

/// `order`: a permutation of the rows, good or bad; its equivalent in postorder is what is used.
Supernodes find_supernodes(const Pattern& pattern, std::vector<int> order);

/// The factor L of a symmetric (real) or Hermitian (complex) positive definite matrix, L L^H.
template <class Scalar>
class Cholesky {
 public:
  /// A pivot that is not above `least` times the diagonal entry that it started from, or is not finite.
  struct Singular {
    int row;
    double diagonal, pivot;
  };

  explicit Cholesky(Supernodes nodes) : nodes_(std::move(nodes)) {}
  /// Throws Singular.
  void factorise(const std::vector<Entry<Scalar>>& lower_triangle, double least);
  /// In place, for one right-hand side.
  void solve(Scalar* x) const;

 private:
  Supernodes nodes_;
  std::vector<Scalar> value_;
};

}  // namespace meshpipe
