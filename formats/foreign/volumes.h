// SPDX-License-Identifier: BSD-3-Clause
// Volume elements of foreign files: where a file has no faces, their outer faces are the surface.
#pragma once
#include <vector>

#include "formats/foreign/polygons.h"

namespace meshpipe {

/// The faces of volume elements, as in Polygons, and the number that was given for the cell of each.
struct Volumes {
  std::vector<int> corners;
  std::vector<std::size_t> ends;
  std::vector<int> cell;
  int count = 0;  ///< cells
};

/// Adds a tetrahedron, pyramid, prism or hexahedron (4, 5, 6 or 8 corners) in the order of Gmsh and Medit:
/// each base counterclockwise seen from inside the cell, then the apex or the other base.
void add_volume(Volumes& volumes, const int* nodes, int n_corners, int cell);

/// Adds to the polygons, if they have no face, those faces that only one cell has, with a remark. Returns the
/// number of the cell of each face that was added.
std::vector<int> add_outer_faces(Polygons& polygons, const Volumes& volumes, Stream& stream);

}  // namespace meshpipe
