// SPDX-License-Identifier: BSD-3-Clause
// Disjoint sets.
#pragma once
#include <algorithm>
#include <numeric>
#include <vector>

namespace meshpipe {

/// Disjoint sets of the numbers 0..n-1, each set named by one of its members.
class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  /// Returns the member that names the set of i.
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins the sets of a and b under the smaller of their names. Returns whether they were two.
  bool join(int a, int b) {
    if (parent_[a] == parent_[b]) return false;
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }
  /// Makes the set named `gone` part of the set named `kept`, which keeps its name.
  void merge_into(int gone, int kept) { parent_[gone] = kept; }

 private:
  std::vector<int> parent_;
};

}  // namespace meshpipe
