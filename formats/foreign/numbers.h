// SPDX-License-Identifier: BSD-3-Clause
// Numbers of nodes or elements in a file, with gaps and in any order, and their rows.
#pragma once
#include <vector>

namespace meshpipe {

class Numbers {
 public:
  /// Adds the number of the next row.
  void add(long long number) { number_.push_back(number); }
  /// Prepares row(); to be called after the last add. Returns a number that is given twice, or 0.
  long long finish();
  /// Returns the row of a number, the first if there are several; or -1.
  int row(long long number) const;
  std::size_t size() const { return number_.size(); }

 private:
  std::vector<long long> number_;  ///< by row; sorted if by_number_ is in use
  std::vector<int> direct_;        ///< row by number - least_, when the numbers are dense enough
  std::vector<int> by_number_;     ///< rows in the order of their numbers, when they are not
  long long least_ = 0;
};

}  // namespace meshpipe
