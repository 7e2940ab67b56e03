// SPDX-License-Identifier: BSD-3-Clause
// What the files of VTK have in common, legacy and XML: points, cells by type, arrays of data.
#pragma once
#include <string>
#include <vector>

#include "formats/columns.h"
#include "formats/polygons.h"

namespace meshpipe {

constexpr int vtk_triangle = 5, vtk_strip = 6, vtk_polygon = 7, vtk_quadratic_triangle = 22;

/// A data set as it is read. `place` in its functions is what messages begin with: "FILE:LINE".
struct VtkData {
  std::vector<Vec3> points;
  Polygons polygons;
  std::vector<int> cell;  ///< of each polygon
  int cells = 0;
  std::vector<Array> point_data, cell_data, field_data;

  /// Counts a cell and keeps it if it is a piece of surface: a polygon, its triangles for a strip, what
  /// add_element makes of a curved one. Throws BadInput for a corner that is no point, and for the kinds of
  /// curved cells whose middle nodes do not lie on the surface.
  void add_cell(int type, const int* corners, std::size_t n, const std::string& place);
};

/// The surface with a column for each array (see add_columns). The patch is the cell array `patch`, or else
/// the first one that other programs label surfaces by; names are field data as written by field_of_names.
/// Arrays of another number of rows than there are points or cells are left out, with a remark.
Stream vtk_surface(VtkData data);

/// Names as meshio has them: an array of the name that holds the tag and the dimension.
std::vector<Array> field_of_names(const Stream& stream);

}  // namespace meshpipe
