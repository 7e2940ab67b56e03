// SPDX-License-Identifier: BSD-3-Clause
// Numbers that a file gives its nodes or elements, with gaps and in any order, and the rows they stand for.
#pragma once
#include <vector>

namespace meshpipe {

class Numbers {
 public:
  /// The number of the next row.
  void add(long long number) { number_.push_back(number); }
  /// To be called after the last add and before row(). A number given twice, or 0.
  long long finish();
  /// The row of a number, or -1; the first one if there are several.
  int row(long long number) const;
  std::size_t size() const { return number_.size(); }

 private:
  std::vector<long long> number_;  ///< by row; sorted if by_number_ is in use
  std::vector<int> direct_;        ///< row by number - least_, when the numbers are dense enough
  std::vector<int> by_number_;     ///< rows in the order of their numbers, when they are not
  long long least_ = 0;
};

}  // namespace meshpipe
