// SPDX-License-Identifier: BSD-3-Clause
// What a file format has no room for.
#pragma once
#include <string>

#include "formats/stream.h"

namespace meshpipe {

/// What of this mesh is not in a file of the format of the extension of `path` (text of it, where it has both
/// and `ascii`), in words: "2 names of patches, vertex data 'pressure'"; empty if all is. What the programs
/// of the chain write for each other does not count. Precondition: the extension is known (see writer_of).
std::string lost_in(const Stream& stream, const std::string& path, bool ascii);

}  // namespace meshpipe
