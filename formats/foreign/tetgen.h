// SPDX-License-Identifier: BSD-3-Clause
// TetGen's .poly and .smesh: the surface as facets with boundary markers.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Writes text with patches as markers of facets, and a point in each region between sheets, whose label is
/// its attribute (tetgen -A). Output only.
std::string write_poly(const Stream& stream, bool ascii);
/// Writes the same with one line per facet (.smesh).
std::string write_smesh(const Stream& stream, bool ascii);

}  // namespace meshpipe
