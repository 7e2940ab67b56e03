// SPDX-License-Identifier: BSD-3-Clause
// A result compared with the surface it was made from.
#pragma once
#include <string>

#include "lib/check/check.h"
#include "tools/io.h"

namespace meshpipe {

/// Compares the result in a stream with the surface in `file`, or with the stream's own if that is empty, and
/// puts that surface into `reference`. Where every triangle of the result has vertices of its own, they are
/// welded. `contract` and `samples` say how closely distances are measured; `least_size` as in examine.
/// `shares`: what was measured in shards, or null; only of the stream's own surface.
/// Throws: BadInput or NotAdmissible if either surface is missing or cannot be measured.
Findings compare(const Io& io, Stream& stream, const std::string& file, const Contract& contract, int samples,
                 Surface& reference, double least_size = 0,
                 const std::vector<ShareFindings>* shares = nullptr);

/// Returns the distance to which surfaces must be known to each other, over the diagonal: as required, less
/// what features removed from the stream's own reference have moved.
double distance_to_know(const Stream& stream, const Contract& contract, const Surface& reference);

}  // namespace meshpipe
