// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/numbers.h"

#include <algorithm>
#include <numeric>

namespace meshpipe {

long long Numbers::finish() {
  if (number_.empty()) return 0;
  const auto [low, high] = std::minmax_element(number_.begin(), number_.end());
  least_ = *low;
  long long twice = 0;
  const auto n = static_cast<unsigned long long>(number_.size());
  const unsigned long long span =
      static_cast<unsigned long long>(*high) - static_cast<unsigned long long>(*low);
  if (span < 4 * n + 1024) {
    direct_.assign(span + 1, -1);
    for (std::size_t i = 0; i < number_.size(); ++i) {
      int& row = direct_[number_[i] - least_];
      if (row >= 0)
        twice = number_[i];
      else
        row = static_cast<int>(i);
    }
    return twice;
  }
  by_number_.resize(number_.size());
  std::iota(by_number_.begin(), by_number_.end(), 0);
  std::stable_sort(by_number_.begin(), by_number_.end(),
                   [&](int a, int b) { return number_[a] < number_[b]; });
  std::sort(number_.begin(), number_.end());
  const auto same = std::adjacent_find(number_.begin(), number_.end());
  return same == number_.end() ? 0 : *same;
}

int Numbers::row(long long number) const {
  if (!direct_.empty()) {
    // unsigned: the difference may be more than a signed number holds
    const auto after = static_cast<unsigned long long>(number) - static_cast<unsigned long long>(least_);
    return number < least_ || after >= direct_.size() ? -1 : direct_[after];
  }
  const auto at = std::lower_bound(number_.begin(), number_.end(), number);
  return at != number_.end() && *at == number ? by_number_[at - number_.begin()] : -1;
}

}  // namespace meshpipe
