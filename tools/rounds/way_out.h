// SPDX-License-Identifier: BSD-3-Clause
// The way out that a message names: the one place where it is decided what helps most likely.
#pragma once
#include <optional>
#include <string>

#include "formats/stream.h"
#include "lib/check/check.h"
#include "lib/core/failure_facts.h"

namespace meshpipe {

/// What to try, and the measurement that speaks for it.
struct WayOut {
  /// Options of mremesh, or "without" and one that was given, or a program with its options to run on the
  /// input first.
  std::string what;
  std::string why;
};

/// Returns what helps after a failure with this exit status; none where the message says it, or nothing is
/// known to help. `history`: the programs that made the surface, whose options are not named again.
/// `diagnosis`: of the surface that was to be remeshed.
std::optional<WayOut> way_out(int status, const FailureFacts& facts, const std::vector<Provenance>& history,
                              const Diagnosis& diagnosis);

}  // namespace meshpipe
