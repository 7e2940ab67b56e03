// SPDX-License-Identifier: BSD-3-Clause
// Faces of any number of corners, as foreign files hold them, and their triangles.
#pragma once
#include <string>
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

/// Faces one after the other: face f has corners[ends[f-1] .. ends[f]) (ends[-1] is 0), a label, and row f of
/// each column.
struct Polygons {
  std::vector<int> corners;
  std::vector<std::size_t> ends;
  std::vector<int> patch;
  Table columns{"face", 0, {}};
  int second_order = 0, higher_order = 0;  ///< finite elements that add_element made flat
};

/// More corners than this in one face are a mistake of the file, and would take quadratic time.
constexpr int max_corners = 10000;

/// Adds a finite element of `n_corners` (3 or 4) corners by all its nodes: the corners, then those within its
/// sides from corner 0 on, then inner ones. One of second order (6 or 7 nodes; 8 or 9) becomes flat faces
/// between its nodes, four or five; one of higher order a face of its corners alone. Returns how many faces
/// it became. set_faces tells of both.
int add_element(Polygons& polygons, const int* nodes, int n_corners, int n_nodes);

/// Triangles of the faces, in order, with their labels as face column `patch`, and the other columns. A
/// quadrilateral is cut along the diagonal that gives the better triangles and does not fold; larger faces
/// lose their ears in the plane that fits them best, so that faces that are not convex come out right too.
/// Faces of fewer than three corners are left out. Precondition: stream.surface.points are set and hold every
/// corner.
void set_faces(Stream& stream, const Polygons& polygons);

/// The face column `patch`; zeros if there is none.
std::vector<int> patches_of(const Stream& stream);

/// Triangles by patch, each in order: triangle numbers first[i] .. first[i+1] of `order` have label tags[i],
/// which increases.
struct ByPatch {
  std::vector<int> tags, order;
  std::vector<std::size_t> first;
};
ByPatch by_patch(const Stream& stream);

/// What to add to every tag so that the smallest is at least 1.
long long shift_to_positive(const ByPatch& by);

}  // namespace meshpipe
