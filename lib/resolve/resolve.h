// SPDX-License-Identifier: BSD-3-Clause
// Self-intersections resolved: triangles divided where they meet, and what lies inside dropped.
#pragma once

#include "lib/core/mesh.h"

namespace meshpipe {

struct ResolveOptions {
  /// What is kept of the pieces: the boundary of positive winding numbers, or all of them.
  enum Keep { outer, all } keep = outer;
};

struct ResolveReport {
  int pairs = 0;         ///< triangles of the input that intersect, touch or overlap
  int triangles = 0;     ///< of the input, in such pairs
  int new_vertices = 0;  ///< of the result, at intersections
  int crumbs = 0;   ///< closed components of almost no volume, cut off at intersections, which are dropped
  int dropped = 0;  ///< pieces that do not bound the outside
  double dropped_area = 0;
  int subtracted = 0;    ///< bodies that are inside out where they overlap others
  int reversed = 0;      ///< pieces kept that were inside out
  int passes = 0;        ///< arrangements, until rounded points intersected nowhere
  double removed = 0;    ///< height of slivers removed between passes
  int left = 0;          ///< pairs that still intersect
  int open = 0;          ///< components of the input with borders or of inconsistent winding
  bool closed = false;   ///< whether the result has no border
  bool nothing = false;  ///< the surface is as it was
};

/// Divides triangles where they intersect, and with `outer` keeps what separates winding numbers above 0 from
/// others: of closed components the result is closed and oriented outward, with edges of two triangles, or
/// more where it touches itself. Components with borders lose what is behind another, or partitions and fins.
/// All edges that meet share their vertices; vertices at intersections are rounded, and what then intersects
/// is divided again. Vertex columns of type double are interpolated, face columns copied. Throws:
/// NotAdmissible if borders leave open what is outside. Source: lib/resolve/outer.h.
ResolveReport resolve(Surface& surface, const ResolveOptions& options = {});

}  // namespace meshpipe
