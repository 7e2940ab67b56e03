// SPDX-License-Identifier: BSD-3-Clause
// VTU and VTP, the XML formats of VTK for unstructured grids and polygons.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_vtk_xml(std::string_view bytes);
/// Either kind: text, base64 or raw bytes, in place or appended, compressed by zlib or not, either byte
/// order, any number of pieces. Polygons, strips and the surface cells of grids, with their data as columns;
/// points, lines and volumes are left out.
Stream read_vtk_xml(std::string_view bytes, const std::string& where);

/// Triangles with every vertex column as a point array and every face column as a cell array; the components
/// of an array and red green blue (`color`) come together again. Text, or base64 of zlib; names of patches
/// are field data: an array of the name that holds the tag and the dimension.
std::string write_vtu(const Stream& stream, bool ascii);
std::string write_vtp(const Stream& stream, bool ascii);

}  // namespace meshpipe
