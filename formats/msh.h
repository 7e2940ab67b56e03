// SPDX-License-Identifier: BSD-3-Clause
// MSH, the format of Gmsh: nodes and elements with tags, names of the tags, data of nodes and elements.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Versions 1, 2, 4.0 and 4.1, text and binary.
bool is_msh(std::string_view bytes);
/// The surface elements (triangles and quadrilaterals of the first order); points, lines and volumes are left
/// out. The patch is the physical tag; for an element without one, the elementary tag counted on from the
/// largest physical one. $NodeData and $ElementData become columns if all nodes or faces have a value.
Stream read_msh(std::string_view bytes, const std::string& where);
/// Versions 2.2 and 4.1. Patches become physical and elementary tags with their names, counted up so that the
/// smallest is 1 if one is below that; columns become $NodeData and $ElementData.
std::string write_msh2(const Stream& stream, bool ascii);
std::string write_msh4(const Stream& stream, bool ascii);

}  // namespace meshpipe
