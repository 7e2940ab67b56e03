// SPDX-License-Identifier: BSD-3-Clause
// The smooth surface that a triangulation stands for, and points of a mesh on it.
#pragma once
#include "lib/lift.h"

namespace meshpipe {

/// A cubic triangle (Vlachos et al. 2001) over each triangle of the surface that a reference was cut from
/// (face column `origin`, if it is there). It passes through the vertices, where its normals are means of
/// those of the triangles (Max 1999) on one side of borders and model edges (face column `model`), or that of
/// a much larger flat piece that ends there. Borders and model edges become smooth curves where they turn by
/// less than 45 degrees; straight ones stay straight, plane regions plane, and ends and junctions are where
/// they were. Curves leave their chords by at most 30 degrees, so no point is farther from the reference than
/// a fifth of the longest edge of its triangle. Keeps a reference to the surface.
class CurvedSurface {
 public:
  explicit CurvedSurface(const Surface& reference);
  /// The point above a place of the reference; that place itself at vertices.
  Vec3 point(const Place& place) const;

 private:
  const Surface& reference_;
  Mesh whole_;                            ///< what the reference was cut from
  std::vector<int> below_;                ///< per triangle of the reference, that of whole_
  std::vector<std::array<Vec3, 2>> off_;  ///< per half-edge: its inner control points less its thirds
};

/// Moves the vertices of a mesh from the reference to the smooth surface. Where triangles would intersect
/// that did not, their vertices stay; returns how many did.
int raise_vertices(LiftedMesh& mesh, const CurvedSurface& surface);

/// A point within edge a, b of a mesh, a < b.
struct MidPoint {
  int a, b;
  Vec3 point;
};

struct MidPoints {
  std::vector<MidPoint> points;  ///< one an edge, by a, then b
  int straight = 0;              ///< those in the middle of their edge, where its triangles would fold
};

/// The middle of every edge, moved to the nearest point of the reference and on to the smooth surface, if
/// that is not null; for borders and model edges, of the border or model edge. A triangle of second order on
/// these nodes that would fold has straight edges.
MidPoints mid_points(const LiftedMesh& mesh, const Surface& reference, const CurvedSurface* surface);

}  // namespace meshpipe
