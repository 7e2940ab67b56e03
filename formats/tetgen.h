// SPDX-License-Identifier: BSD-3-Clause
// TetGen's .poly: the surface as facets with boundary markers.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Patches become the markers of facets. Output only, always text.
std::string write_poly(const Stream& stream, bool ascii);

}  // namespace meshpipe
