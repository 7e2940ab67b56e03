// SPDX-License-Identifier: BSD-3-Clause
// GTS, the format of the GNU Triangulated Surface library: triangles of edges of vertices.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Writes text without patches and data. Output only.
std::string write_gts(const Stream& stream, bool ascii);

}  // namespace meshpipe
