// SPDX-License-Identifier: BSD-3-Clause
// MSH, the format of Gmsh: nodes and elements with tags, names of the tags, data of nodes and elements.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_msh(std::string_view bytes);
/// Reads versions 1, 2, 4.0 and 4.1, text and binary: triangles and quadrilaterals of any order
/// (add_element), without these the outer faces of volumes, and line elements along edges as lines of the
/// model. The patch, or the label of a line, is the physical tag; elements without one have their elementary
/// tag, counted on from the largest physical one. $NodeData and $ElementData become columns if all nodes or
/// faces have a value.
Stream read_msh(std::string_view bytes, const std::string& where);
/// Writes version 2.2, or 4.1. Patches become physical and elementary tags with their names, shifted so that
/// the smallest is at least 1; so do labels of lines above 0. Columns become $NodeData and $ElementData.
std::string write_msh2(const Stream& stream, bool ascii);
std::string write_msh4(const Stream& stream, bool ascii);

/// Encodes a name for double quotes: `"` as %22, and a % that would begin such a code as %25; the second
/// decodes it.
std::string quotable(std::string_view name);
std::string unescaped(std::string_view name);

}  // namespace meshpipe
