// SPDX-License-Identifier: BSD-3-Clause
// Volume elements of foreign files: where a file has no faces, their outer faces are the surface.
#pragma once
#include <string>
#include <vector>

#include "formats/foreign/polygons.h"

namespace meshpipe {

/// Tetrahedra, pyramids, prisms and hexahedra, by their 4, 5, 6 or 8 corners.
struct Volumes {
  std::vector<int> corners;
  std::vector<char> kind;  ///< number of corners
  std::vector<int> cell;   ///< the number that was given
  int curved = 0;          ///< elements with nodes other than corners
  std::string unread;      ///< message on the first element of another kind; empty: there is none
};

/// Adds an element by its nodes, corners first in the order of Gmsh and Medit: the first base
/// counterclockwise seen from inside, then the apex or the other base.
void add_volume(Volumes& volumes, const int* nodes, int n_corners, int n_nodes, int cell);

/// Adds to the polygons, if they have no face, those faces that only one element has, with a remark. Corners
/// at the same place are one, and so are elements with the same corners: in Gmsh one is written for each of
/// its groups. Returns the number of the element of each face that was added. Throws: BadInput `unread`.
/// Requires: the points of stream.surface.
std::vector<int> add_outer_faces(Polygons& polygons, const Volumes& volumes, Stream& stream);

}  // namespace meshpipe
