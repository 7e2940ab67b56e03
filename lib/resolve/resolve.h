// SPDX-License-Identifier: BSD-3-Clause
// Self-intersections resolved: triangles divided where they meet, and what lies inside dropped.
#pragma once
#include <string>

#include "lib/core/mesh.h"

namespace meshpipe {

struct ResolveOptions {
  /// What is kept of the pieces: the boundary between winding number 0 and others, or all of them.
  enum Keep { outer, all } keep = outer;
};

struct ResolveReport {
  int pairs = 0;         ///< triangles of the input that intersect, touch or overlap
  int triangles = 0;     ///< of the input, in such pairs
  int new_vertices = 0;  ///< of the result, at intersections
  int dropped = 0;       ///< pieces inside or without a side outside
  double dropped_area = 0;
  int reversed = 0;      ///< pieces kept that had to be reversed
  int passes = 0;        ///< arrangements, until rounded points intersected nowhere
  double removed = 0;    ///< height of slivers removed between passes
  int left = 0;          ///< pairs that still intersect
  int open = 0;          ///< components with borders, which are kept
  bool closed = false;   ///< whether the result has no border
  bool nothing = false;  ///< the surface is as it was
};

/// Divides triangles where they intersect, and keeps what bounds the outside: the result is closed and
/// oriented outward, its edges have two triangles, or more where it touches itself. Vertices at intersections
/// are rounded, and what intersects then is divided again. All edges that meet share their vertices.
/// Vertex data of type double are interpolated; face data are those of the triangle divided.
/// Requires: consistent orientation. Throws: NotAdmissible if components with borders intersect.
/// Source: Zhou, Grinspun, Zorin, Jacobson, Mesh Arrangements for Solid
/// Geometry, 2016.
ResolveReport resolve(Surface& surface, const ResolveOptions& options = {});

}  // namespace meshpipe
