// SPDX-License-Identifier: BSD-3-Clause
// MSH, the format of Gmsh: nodes and elements with tags, names of the tags, data of nodes and elements.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Versions 1, 2, 4.0 and 4.1, text and binary.
bool is_msh(std::string_view bytes);
/// The surface elements (triangles and quadrilaterals; those of higher order as add_element has them), and
/// line elements along their edges as lines of the model; points and volumes are left out. The patch, or the
/// label of a line, is the physical tag; for an element without one, the elementary tag counted on from the
/// largest physical one. $NodeData and $ElementData become columns if all nodes or faces have a value.
Stream read_msh(std::string_view bytes, const std::string& where);
/// Versions 2.2 and 4.1. Patches become physical and elementary tags with their names, counted up so that the
/// smallest is 1 if one is below that, and so do the labels of lines that are above 0; columns become
/// $NodeData and $ElementData.
std::string write_msh2(const Stream& stream, bool ascii);
std::string write_msh4(const Stream& stream, bool ascii);

/// Names in double quotes, as the format has them, cannot hold any: `"` is written %22, and a % that would be
/// taken for the start of that %25. And back.
std::string quotable(std::string_view name);
std::string unescaped(std::string_view name);

}  // namespace meshpipe
