// SPDX-License-Identifier: BSD-3-Clause
// Gmsh's .geo: the volumes between the surfaces of a .msh file.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Writes a volume per region between sheets, bounded by its patches, as a physical volume of its label; one
/// volume if there are no sheets. To be read by gmsh after the .msh file of the same stream. Output only.
std::string write_geo(const Stream& stream, bool ascii);

}  // namespace meshpipe
