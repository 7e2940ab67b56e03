// SPDX-License-Identifier: BSD-3-Clause
// The bulk data of Nastran: GRID* and CTRIA3.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Patches become properties (PID), counted up so that the smallest is 1, their names comments.n///
/// Coordinates have the digits that fit 16 columns. Throws CannotWrite for numbers that do not fit 8 columns.
/// Output only, always text.
std::string write_nastran(const Stream& stream, bool ascii);

}  // namespace meshpipe
