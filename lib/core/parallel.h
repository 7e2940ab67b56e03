// SPDX-License-Identifier: BSD-3-Clause
// Loops over independent pieces of work on all threads.
#pragma once
#include <omp.h>

#include <algorithm>
#include <exception>
#include <vector>

#include "lib/core/lists.h"

namespace meshpipe {

/// Calls f(i) for 0 <= i < n in any order, on all threads, or on one if it is not `worth` them. In a loop
/// within a loop, threads that have come to the end of the outer one help. If calls throw, rethrows after all
/// of them what the smallest i threw: the same at any number of threads.
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
  if (worth && n > 1 && omp_in_parallel()) {
#pragma omp taskloop grainsize(1)
    for (int i = 0; i < n; ++i) call(i);
  } else if (worth && n > 1) {
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < n; ++i) call(i);
  } else {
    // no region, in which loops of f would have to start threads of their own
    for (int i = 0; i < n; ++i) call(i);
  }
  for (const std::exception_ptr& e : failed)
    if (e) std::rethrow_exception(e);
}

/// Calls f(i) as parallel_for does, for pieces of work too small to be given to a thread one by one.
template <class F>
void parallel_for_small(int n, F f) {
  constexpr int chunk = 4096;
  parallel_for((n + chunk - 1) / chunk, [&](int c) {
    for (int i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) f(i);
  });
}

/// Returns 0 .. n - 1 with the largest size(i) first: in this order no thread is left with a long piece.
template <class Size>
std::vector<int> largest_first(int n, Size size) {
  std::vector<int> order = identity(n);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return size(i) > size(j); });
  return order;
}

}  // namespace meshpipe
