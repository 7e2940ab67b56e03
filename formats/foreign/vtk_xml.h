// SPDX-License-Identifier: BSD-3-Clause
// VTU and VTP, the XML formats of VTK for unstructured grids and polygons.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_vtk_xml(std::string_view bytes);
/// Reads UnstructuredGrid and PolyData: text, base64 or raw bytes, in place or appended, with or without
/// zlib, in either byte order and any number of pieces. Polygons, strips and surface cells come with their
/// data as columns, without these the outer faces of volumes; points and lines are left out.
Stream read_vtk_xml(std::string_view bytes, const std::string& where);

/// Writes triangles with vertex columns as point arrays and face columns as cell arrays; components of an
/// array, and red green blue as `color`, are joined again. Names of patches are field data (field_of_names).
/// Text, or base64 of zlib.
std::string write_vtu(const Stream& stream, bool ascii);
std::string write_vtp(const Stream& stream, bool ascii);

}  // namespace meshpipe
