// SPDX-License-Identifier: BSD-3-Clause
// How far the work has come, for whoever shows it.
#pragma once
#include <atomic>

namespace meshpipe {

/// The share of the work that is done, from 0 to 1, for whoever shows it. Long loops raise it, from any
/// thread; no result depends on it.
inline std::atomic<double> work_done{0};
inline void add_progress(double share) {
  double before = work_done.load(std::memory_order_relaxed);  // libc++ 14 adds integers only
  while (!work_done.compare_exchange_weak(before, before + share, std::memory_order_relaxed)) {
  }
}

}  // namespace meshpipe
