// SPDX-License-Identifier: BSD-3-Clause
// Loops over independent pieces of work on all threads.
#pragma once
#include <exception>
#include <vector>

namespace meshpipe {

/// Calls f(i) for 0 <= i < n in any order, on as many threads as OpenMP has. Every call is made, even if some
/// throw; then what the smallest i threw is thrown here, so that failures do not depend on the threads.
template <class F>
void parallel_for(int n, F f) {
  std::vector<std::exception_ptr> failed(n);
#pragma omp parallel for schedule(dynamic) if (n > 1)
  for (int i = 0; i < n; ++i) {
    // nothing may leave a parallel region by an exception
    try {
      f(i);
    } catch (...) {
      failed[i] = std::current_exception();
    }
  }
  for (const std::exception_ptr& e : failed)
    if (e) std::rethrow_exception(e);
}

}  // namespace meshpipe
