// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that are the same with every compiler and library (those of <random> are not).
#pragma once
#include <cstdint>

#include "lib/core/vec.h"

namespace meshpipe {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  /// Returns a number in [0, 1).
  double uniform() { return (double)(bits() >> 11) * 0x1p-53; }
  /// Returns an integer in 0..n-1.
  int below(int n) { return (int)(uniform() * n); }
  /// Returns a point in the unit ball, uniformly distributed.
  Vec3 in_ball() {
    for (;;) {
      const Vec3 p{2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1};
      if (dot(p, p) <= 1) return p;
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace meshpipe
