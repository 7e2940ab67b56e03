// SPDX-License-Identifier: BSD-3-Clause
// The number after which new patches are numbered.
#pragma once
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "lib/core/error.h"

namespace meshpipe {

/// Returns the largest of these patch numbers, or 0 if none is positive. Throws: NotAdmissible if fewer than
/// `more` larger ints exist.
inline int largest_patch(const std::vector<int>& patch, std::size_t more) {
  const int most = patch.empty() ? 0 : std::max(0, *std::max_element(patch.begin(), patch.end()));
  if (more > (std::size_t)(std::numeric_limits<int>::max() - most))
    throw NotAdmissible("patch " + std::to_string(most) + " leaves no numbers for " + std::to_string(more) +
                        " more patches");
  return most;
}

}  // namespace meshpipe
