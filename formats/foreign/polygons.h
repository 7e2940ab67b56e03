// SPDX-License-Identifier: BSD-3-Clause
// Faces of any number of corners, as foreign files hold them, and their triangles.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

/// Faces of a file: face f has corners[ends[f-1] .. ends[f]) (ends[-1] is 0), a label, and row f of each
/// column.
struct Polygons {
  std::vector<int> corners;
  std::vector<std::size_t> ends;
  std::vector<int> patch;
  Table columns{"face", 0, {}};
  int second_order = 0, higher_order = 0;           ///< finite elements that add_element made flat
  std::vector<std::pair<int, std::uint8_t>> inner;  ///< of those, triangles with edges (bits) in an element
};

/// The largest number of corners of a face: more are an error in the file, and would take quadratic time.
constexpr int max_corners = 10000;

/// Adds a finite element of 3 or 4 corners by its nodes: corners, nodes within sides from corner 0 on, inner
/// nodes. An element of second order (6 or 7, 8 or 9 nodes) becomes four or five flat faces between its
/// nodes, one of higher order the face of its corners; set_faces remarks on both. Returns the number of
/// faces.
int add_element(Polygons& polygons, const int* nodes, int n_corners, int n_nodes);

/// Triangulates the faces into stream.surface, in order, with labels as face column `patch` and the other
/// columns; edges within an element get no bit of column `model`. Quadrilaterals are split along the better
/// diagonal that does not fold; larger faces by ear clipping in the coordinate plane that shows them largest.
/// Faces of fewer than three corners are left out. Requires: the points of stream.surface, which include
/// every corner.
void set_faces(Stream& stream, const Polygons& polygons);

/// Returns face column `patch`; zeros if there is none.
std::vector<int> patches_of(const Stream& stream);

/// Triangles sorted by patch: order[first[i]] .. order[first[i+1]-1] have label tags[i]; tags ascend.
struct ByPatch {
  std::vector<int> tags, order;
  std::vector<std::size_t> first;
};
ByPatch by_patch(const Stream& stream);

/// Returns the number to add to every tag so that the smallest is at least 1.
long long shift_to_positive(const ByPatch& by);

}  // namespace meshpipe
