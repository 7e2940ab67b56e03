// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>

using namespace meshpipe;

TEST(ParallelFor, MakesEveryCallAndThrowsWhatTheFirstDid) {
  for (bool worth : {true, false}) {
    std::atomic<int> calls = 0;
    std::string thrown;
    try {
      parallel_for(
          100,
          [&](int i) {
            ++calls;
            if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
          },
          worth);
    } catch (const std::runtime_error& e) {
      thrown = e.what();
    }
    EXPECT_EQ(calls, 100);
    EXPECT_EQ(thrown, "7");
  }
}

TEST(ParallelFor, DoesNothingForNoIndex) {
  parallel_for(0, [](int) { FAIL(); });
}
