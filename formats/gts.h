// SPDX-License-Identifier: BSD-3-Clause
// GTS, the format of the GNU Triangulated Surface library: triangles of edges of vertices.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Patches and data are not kept. Output only, always text.
std::string write_gts(const Stream& stream, bool ascii);

}  // namespace meshpipe
