// SPDX-License-Identifier: BSD-3-Clause
// Facts about a failure in addition to its message, by which a way out is chosen (tools/rounds/way_out.h).
#pragma once
#include <exception>
#include <string>
#include <utility>

#include "lib/core/vec.h"

namespace meshpipe {

struct FailureFacts {
  double least_size = 0;      ///< sizes from here on can be met, with a margin; 0: unknown
  double strip_width = 0;     ///< strips narrower than this ask for too many triangles; 0: none do
  double narrow_width = 0;    ///< distance around parts or between sheets that ask for too many triangles
  bool far_off = false;       ///< the coordinates are too coarse, and finer near the origin
  std::string requirement{};  ///< of the contract, the first that is missed,
  double value = 0;           ///< and what was reached of it
  Vec3 place{};               ///< where it failed, if `reach` is above 0,
  double reach = 0;           ///< and the lengths of edges there
  bool in_plane = false;      ///< `place` is u v 0 of a chart
};

inline FailureFacts sizes_from(double least) { return {.least_size = least}; }

/// A failure that carries its facts; caught as the failure it is.
template <class Failure>
struct Informed : Failure, FailureFacts {
  Informed(const std::string& what, FailureFacts facts) : Failure(what), FailureFacts(std::move(facts)) {}
};

/// Returns the facts of a failure, if it carries any.
inline FailureFacts facts_of(const std::exception& failure) {
  const auto* facts = dynamic_cast<const FailureFacts*>(&failure);
  return facts ? *facts : FailureFacts{};
}

}  // namespace meshpipe
