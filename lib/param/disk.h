// SPDX-License-Identifier: BSD-3-Clause
// The disk with holes that maps are computed on: its holes are filled by virtual triangles, which take part
// in the solves and are dropped afterwards.
#pragma once
#include "lib/core/connectivity.h"
#include "lib/numeric/laplacian.h"

namespace meshpipe {

/// A part's connectivity, and its border loops with the longest first.
struct Disk {
  std::vector<int> opposite;
  std::vector<std::vector<int>> loops;
  std::vector<double> length;
};

/// Returns the connectivity and the loops of a part. Throws: NotAdmissible if the part is not connected,
/// touches itself at a vertex, or is no disk with holes.
Disk disk_of(const SubMesh& part);

/// Corners of triangles in space, with no regard to their neighbors.
using Shapes = std::vector<std::array<Vec3, 3>>;

/// The triangles of a part, then those that fill its holes: a fan around a virtual center vertex for each
/// loop but the longest. Centers are numbered after the part's vertices, in the order of the loops.
struct Filled {
  std::vector<Tri> tris;
  /// Per triangle: its corners in space; those of a fan lie in a plane of their own.
  Shapes shape;
  int n_vertices = 0;
};

/// Returns the part alone: its holes keep the natural boundary condition.
Filled open_holes(const SubMesh& part);

/// Fills each hole by isosceles triangles whose angle at the center is the edge's share of the loop, as for a
/// circular hole of the same perimeter. Angles stay below 135 degrees.
Filled round_holes(const SubMesh& part, const Disk& disk);

/// Returns the intrinsic Delaunay triangulation (lib/param/intrinsic.h) of the part with its holes filled. A
/// hole whose border turns by 2 pi on the part is filled by its plane polygon, if that is star-shaped around
/// its middle, so that flat parts stay flat; the others as in round_holes. A conformal map of the filled part
/// is one of the part, whatever fills it.
Filled flat_holes(const SubMesh& part, const Disk& disk);

/// Returns the cotangent weight (lib/numeric/laplacian.h) of every half-edge, between `floor` and `ceiling`.
std::vector<double> cotangents(const Shapes& shapes, double floor = -1e30, double ceiling = 1e30);

/// Returns per vertex the sum of its angles, from cotangent weights, finite also without area.
std::vector<double> angle_sums(const Filled& filled, const std::vector<double>& cotangents);

/// Factorizes the Laplacian of unknowns 0..n-1; unknown[v]: of vertex v, shared or not; negative: held.
Factorization<double> laplacian(const Filled& filled, const std::vector<double>& weights,
                                const std::vector<int>& unknown, int n);

/// Returns per vertex the angle by which the border turns there once the metric is scaled by exp(scale)
/// (`scale`: per vertex): its own turn and the flux of the scale (the Cherrier formula).
std::vector<double> turns(const Filled& filled, const std::vector<double>& weights,
                          const std::vector<double>& angle_sum, const std::vector<double>& scale);

/// Returns the polygon of a loop with these turns (per vertex) and edge lengths (per edge of the loop), in
/// the order of the loop. Discretization leaves a gap: the lengths l become l (1 - c . direction), the least
/// change over l that closes it. Empty if a length would not stay positive, or is beyond doubles.
std::vector<Vec2> polygon_of(const SubMesh& part, const std::vector<int>& loop,
                             const std::vector<double>& turn, const std::vector<double>& length);

/// Scales a map to the area that the part has in space; does nothing if either area is not positive.
void scale_to_area(const SubMesh& part, std::vector<Vec2>& uv);

}  // namespace meshpipe
