// SPDX-License-Identifier: BSD-3-Clause
// MSH 2.2, the text format of Gmsh: nodes and elements with tags, and names of the tags.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_msh(std::string_view bytes);
/// The surface elements (triangles and quadrilaterals of the first order); points, lines and volumes are left
/// out. The patch is the physical tag; for an element without one, the elementary tag counted on from the
/// largest physical one.
Stream read_msh(std::string_view bytes, const std::string& where);
/// Patches become physical and elementary tags with their names, counted up so that the smallest is 1 if one
/// is below that.
std::string write_msh(const Stream& stream, bool ascii);

}  // namespace meshpipe
