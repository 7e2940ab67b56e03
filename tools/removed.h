// SPDX-License-Identifier: BSD-3-Clause
// What the removal of small features is reported as.
#pragma once
#include "lib/defeature/defeature.h"
#include "tools/io.h"

namespace meshpipe {

/// Prints the flips, if there are any; adds their number to the report as `flipped`.
void report_flips(Io& io, const Flips& flips);

/// Prints what was removed, where, and how wide it was, with the patches that vanished by the names in
/// `stream`; adds it to the report as `tolerance`, `moved`, `removed` and `vanished`.
void report_removed(Io& io, const DefeatureReport& r, double tolerance, const Stream& stream);

}  // namespace meshpipe
