// SPDX-License-Identifier: BSD-3-Clause
// VTU, the XML format of VTK for unstructured grids.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Triangles with every vertex column as a point array and every face column as a cell array; red green blue
/// become one array `color`. Binary (base64) or text; names of patches are field data `patch_tag` and
/// `patch_name`.
std::string write_vtu(const Stream& stream, bool ascii);

}  // namespace meshpipe
