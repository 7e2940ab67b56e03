// SPDX-License-Identifier: BSD-3-Clause
// Loops over independent pieces of work on all threads.
#pragma once
#include <omp.h>

#include <exception>
#include <vector>

namespace meshpipe {

/// Calls f(i) for 0 <= i < n in any order, on all threads, or on one if it is not `worth` them. If calls
/// throw, rethrows after all of them what the smallest i threw: the same at any number of threads.
template <class F>
void parallel_for(int n, F f, bool worth = true) {
  std::vector<std::exception_ptr> failed(n);
  auto call = [&](int i) {
    // nothing may leave a parallel region by an exception
    try {
      f(i);
    } catch (...) {
      failed[i] = std::current_exception();
    }
  };
  if (worth && n > 1) {
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < n; ++i) call(i);
  } else {
    // no region, in which loops of f would have to start threads of their own
    for (int i = 0; i < n; ++i) call(i);
  }
  for (const std::exception_ptr& e : failed)
    if (e) std::rethrow_exception(e);
}

/// Returns the number of the thread for memory of its own, from inside of f in parallel_for(n, f, worth):
/// below omp_get_max_threads() before the loop. Where that opens no region the thread may have a larger
/// number.
inline int thread_of_loop(int n, bool worth = true) { return worth && n > 1 ? omp_get_thread_num() : 0; }

}  // namespace meshpipe
