// SPDX-License-Identifier: BSD-3-Clause
// Lists of numbers: what std::vector lacks, and rows by key in flat arrays.
#pragma once
#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace meshpipe {

template <class T>
void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Removes the last element of a list and returns it.
template <class T>
T take_last(std::vector<T>& list) {
  T last = std::move(list.back());
  list.pop_back();
  return last;
}

/// Returns the numbers 0 .. n - 1.
inline std::vector<int> identity(std::size_t n) {
  std::vector<int> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Lists of rows, one per key, in flat arrays: key k has row[start[k]] to row[start[k + 1] - 1].
struct Lists {
  std::vector<int> start, row;
  std::span<const int> operator[](int key) const {
    return std::span(row).subspan(start[key], start[key + 1] - start[key]);
  }
};

/// Makes the lists of the pairs (key, row) for which `each` calls its argument, in that order; `each` is
/// called twice and must do the same. Keys are 0..keys-1. Linear.
template <class Each>
Lists lists_of(int keys, Each each) {
  Lists lists{std::vector<int>(keys + 1, 0), {}};
  each([&](int key, int) { ++lists.start[key + 1]; });
  std::partial_sum(lists.start.begin(), lists.start.end(), lists.start.begin());
  lists.row.resize(lists.start.back());
  std::vector<int> at(lists.start.begin(), lists.start.end() - 1);
  each([&](int key, int row) { lists.row[at[key]++] = row; });
  return lists;
}

/// Makes the lists of the rows of each key, ascending. `key`: per row, 0..keys-1.
inline Lists lists_by(int keys, const std::vector<int>& key) {
  return lists_of(keys, [&](auto use) {
    for (int row = 0; row < (int)key.size(); ++row) use(key[row], row);
  });
}

}  // namespace meshpipe
