// SPDX-License-Identifier: BSD-3-Clause
// The legacy format of VTK.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_vtk_legacy(std::string_view bytes);
/// Reads data sets POLYDATA and UNSTRUCTURED_GRID of any version, text or binary: polygons, strips and
/// surface cells, with their data as columns; without these the outer faces of volumes. Points and lines are
/// left out.
Stream read_vtk_legacy(std::string_view bytes, const std::string& where);
/// Writes version 3 with every column as data and names as field data (field_of_names): an UNSTRUCTURED_GRID,
/// which more programs read, or POLYDATA.
std::string write_vtk_grid(const Stream& stream, bool ascii);
std::string write_vtk_polydata(const Stream& stream, bool ascii);

}  // namespace meshpipe
