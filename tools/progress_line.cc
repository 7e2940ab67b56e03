// SPDX-License-Identifier: BSD-3-Clause
#include "tools/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>

#include "lib/core/progress.h"

namespace meshpipe {
namespace {

std::atomic<Phase> phase = Phase::waiting;

/// The share of all work that is done, 0 to 1. Reading and writing a stream take about equally long.
double share_done() {
  constexpr double to_read = 0.2, to_write = 0.2;
  switch (phase.load()) {
    case Phase::working:
      return to_read + (1 - to_read - to_write) * std::min(1.0, work_done.load());
    case Phase::writing:
      return 1 - to_write;
    default:
      return 0;
  }
}

}  // namespace

void set_phase(Phase now) { phase = now; }

void note_input_begins() {
  Phase before = Phase::waiting;
  phase.compare_exchange_strong(before, Phase::reading);
}

ProgressLine::ProgressLine(const std::string& program, bool quiet) {
  if (!quiet && ::isatty(STDERR_FILENO)) thread_ = std::thread([this, program] { watch(program); });
}

ProgressLine::~ProgressLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void ProgressLine::watch(const std::string& program) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds interval(200);
  Clock::time_point begun{};
  bool shown = false;
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, interval, [this] { return over_; })) {
    if (phase == Phase::waiting) continue;
    if (begun == Clock::time_point{}) begun = Clock::now();
    const double seconds = std::chrono::duration<double>(Clock::now() - begun).count(), share = share_done();
    if (seconds < 1 || share <= 0) continue;
    std::fprintf(stderr, "\r%s: %.0f %%, %.0f s left\033[K\r", program.c_str(), 100 * share,
                 seconds * (1 - share) / share);
    shown = true;
  }
  if (shown) std::fputs("\r\033[K", stderr);
}

}  // namespace meshpipe
