// SPDX-License-Identifier: BSD-3-Clause
// A part as the maps see it: a disk with holes, the holes filled by virtual triangles that take part in the
// solves and are dropped afterwards.
#pragma once
#include "lib/mesh.h"
#include "lib/sparse.h"

namespace meshpipe {

/// A part's connectivity, and its border loops with the longest first.
struct Disk {
  std::vector<int> opposite;
  std::vector<std::vector<int>> loops;
  std::vector<double> length;
};

/// Throws NotAdmissible if the part is not connected, touches itself at a vertex, or is no disk with holes.
Disk disk_of(const SubMesh& part);

/// Length in space of half-edge h.
double edge_length(const Mesh& mesh, int h);

/// Corners of triangles in space, with no regard to their neighbours.
using Shapes = std::vector<std::array<Vec3, 3>>;

/// The part's triangles, then those that fill its holes: a fan around a virtual centre vertex for each loop
/// but the longest, numbered after the part's vertices in the order of the loops.
struct Filled {
  std::vector<Tri> tris;
  /// Per triangle: its corners in space; those of a fan lie in a plane of their own.
  Shapes shape;
  int n_vertices = 0;
};

/// The part alone: holes keep the natural condition.
Filled open_holes(const SubMesh& part);

/// Each hole filled by isosceles triangles whose angle at the centre is the edge's share of the loop, as for
/// a round hole of the same perimeter. Angles stay below 135 degrees.
Filled round_holes(const SubMesh& part, const Disk& disk);

/// The intrinsic Delaunay triangulation (lib/param_intrinsic.h) of the part with its holes filled: those
/// whose border turns by one round on the part, to 0.1, by the polygon with its turns and lengths, if that is
/// star-shaped around its middle, so that what is flat stays flat; the others as in round_holes. A conformal
/// map of the filled part is one of the part whatever fills it.
Filled flat_holes(const SubMesh& part, const Disk& disk);

/// Cotangent weights (lib/sparse.h) of every half-edge.
std::vector<double> cotangents(const Shapes& shapes, double floor = -1e30, double ceiling = 1e30);

/// Sum of the angles around each vertex, from cotangent weights: the angles of triangles that have none of
/// their own (no area) are then those that the weights stand for.
std::vector<double> angle_sums(const Filled& filled, const std::vector<double>& cotangents);

/// The Laplacian of the unknowns 0..n-1, factorised; unknown[v] < 0: v is held; vertices may share an
/// unknown.
Factorisation<double> laplacian(const Filled& filled, const std::vector<double>& weights,
                                const std::vector<int>& unknown, int n, SolveTime* time);

/// turn[v]: how much the border turns at its vertices v once the metric is scaled by exp(scale): its own turn
/// and the flux of the scale (the Cherrier formula).
std::vector<double> turns(const Filled& filled, const std::vector<double>& weights,
                          const std::vector<double>& angle_sum, const std::vector<double>& scale);

/// The polygon of a loop with these turns (per vertex) and edge lengths (per edge of the loop); places in the
/// order of the loop. It closes but for discretisation: the lengths l are changed to l (1 - c . direction),
/// the least change over l that closes it. Empty if a length would not stay positive, or is beyond doubles.
std::vector<Vec2> polygon_of(const SubMesh& part, const std::vector<int>& loop,
                             const std::vector<double>& turn, const std::vector<double>& length);

/// Scales a map to the area that the part has in space; nothing if either is not positive.
void scale_to_area(const SubMesh& part, std::vector<Vec2>& uv);

}  // namespace meshpipe
