// SPDX-License-Identifier: BSD-3-Clause
// The input file of Abaqus: nodes, elements of type S3, a set for each patch.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Sets are named like their patch, with what Abaqus does not take in a name as '_'. Output only, always
/// text.
std::string write_abaqus(const Stream& stream, bool ascii);

}  // namespace meshpipe
