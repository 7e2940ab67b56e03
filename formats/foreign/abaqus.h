// SPDX-License-Identifier: BSD-3-Clause
// The input file of Abaqus: nodes, elements of type S3, a set for each patch.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Writes text with one element set per patch, named like it; characters that Abaqus does not allow become
/// '_'. Output only.
std::string write_abaqus(const Stream& stream, bool ascii);

}  // namespace meshpipe
