// SPDX-License-Identifier: BSD-3-Clause
// What legacy and XML files of VTK share: points, cells by type, arrays of data.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "formats/foreign/columns.h"
#include "formats/foreign/polygons.h"
#include "formats/foreign/volumes.h"

namespace meshpipe {

constexpr int vtk_line = 3, vtk_polyline = 4, vtk_triangle = 5, vtk_strip = 6, vtk_polygon = 7,
              vtk_quadratic_triangle = 22;

/// A data set of VTK while it is read.
struct VtkData {
  std::vector<Vec3> points;
  Polygons polygons;
  std::vector<int> cell;                  ///< of each polygon
  std::vector<std::array<int, 3>> lines;  ///< from point to point, and the cell
  Volumes volumes;
  int cells = 0;
  std::vector<Array> point_data, cell_data, field_data;

  /// Counts a cell, and adds it if it is a piece of surface (a polygon, a strip, or a curved one, as
  /// add_element makes it flat), or a volume while there is no such piece. Throws: BadInput, which begins
  /// with `place` ("FILE:LINE"), for a corner that is no point, and for curved cells of the kinds whose
  /// middle nodes do not lie on the surface.
  void add_cell(int type, const int* corners, std::size_t n, const std::string& place);
};

/// Returns the surface, or that of the volumes, or else the lines, with one column per array (add_columns).
/// The patch is cell array `patch`, or else the first array by which other programs label surfaces; names are
/// field data as in field_of_names. Arrays whose number of rows is not that of points or cells are left out,
/// with a remark.
Stream vtk_surface(VtkData data);

/// Returns names of patches and lines as meshio has them: per name an array of that name with the tag and the
/// dimension.
std::vector<Array> field_of_names(const Stream& stream);

}  // namespace meshpipe
