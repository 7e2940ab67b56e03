// SPDX-License-Identifier: BSD-3-Clause
// The bulk data of Nastran: GRID* and CTRIA3.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Writes text: patches become properties (PID), shifted so that the smallest is at least 1, their names
/// comments; coordinates have the digits that fit 16 columns. Output only.
/// Throws: CannotWrite for numbers that do not fit 8 columns.
std::string write_nastran(const Stream& stream, bool ascii);

}  // namespace meshpipe
