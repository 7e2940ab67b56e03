// SPDX-License-Identifier: BSD-3-Clause
// Meshes on a reference surface: plane meshes lifted back and glued, meshes from elsewhere placed on it,
// the smooth surface that it stands for, and nodes of second order.
#pragma once
#include <optional>

#include "lib/lines/lines.h"
#include "lib/mesh2d/mesh2d.h"

namespace meshpipe {

/// A mesh each of whose vertices has a place on a reference surface.
struct LiftedMesh : Mesh {
  std::vector<Place> place;         ///< triangle of the reference and barycentrics
  std::vector<int> kind;            ///< 0 inside, 1 on a line, 2 corner (end of lines)
  std::vector<int> line;            ///< line it lies on, or -1
  std::vector<double> size;         ///< size field, interpolated
  std::vector<int> patch;           ///< per triangle, by place on the reference
  std::vector<int> part;            ///< per triangle
  std::vector<std::uint8_t> model;  ///< per triangle: bit i: edge from corner i to i+1 is a model edge
};

/// Lifts the plane meshes of all charts by barycentric coordinates and glues them along the lines. Line
/// points come first, in the order of their rows, then inside points by part. Each region between model edges
/// and borders gets the patch label that covers most of the reference's area below it. Requires: vertex
/// column `size`; a chart and its plane mesh per part, in one order, made with these lines. Throws: BadInput
/// for a line point on an edge that the reference lacks; GoalMissed naming the vertex or edge where the
/// result is no manifold, is pinched, or has a border that is no border line.
LiftedMesh lift(const Surface& reference, std::vector<Chart> charts, const Lines& lines,
                const std::vector<PlaneMesh>& meshes);

/// Moves every vertex of a mesh to the nearest point of the reference: its border to the reference's border,
/// and its model edges (face column `model`) to the reference's model edges, where there are any. Sizes come
/// from the reference's column `size`, else from the edge length that gives the mesh's triangle count.
/// Requires: both have triangles; the mesh is an oriented manifold. Throws: NotAdmissible if more than half
/// of the vertices are farther away than the mean edge length.
LiftedMesh place_on(const Surface& mesh, const Surface& reference);

/// Contracts edges of a surface as far as a mesh of this size permits: none gets longer than the size, and
/// the planes of all triangles that became a vertex are within 0.02 of it (lib/core/coarsen.h), and within
/// 1/40 of the distance of the next sheet. Corners of the model stay, and on request the border. Returns
/// nothing, and the reason, if more than half of the triangles would stay, or the surface or all coarse
/// models intersect themselves. `s` is as before. Requires: triangles. Throws: as opposite_halfedges;
/// NotAdmissible at a pinched vertex.
std::optional<Surface> coarse_surface(Surface& s, double size, bool keep_border, std::string& reason);

/// Moves a mesh and its lines from the coarse surface that they were made on to the fine one that this stands
/// for: borders and model edges to the nearest ones, what is inside to the nearest point that faces the same
/// way, points of interfaces to vertices. The fine surface gets the vertex data that only the coarse one has
/// (doubles), as column `size`. Requires: both have triangles; the places are on the coarse one, whose lines
/// are nearly those of the fine one.
void move_to_fine(LiftedMesh& mesh, Lines& lines, const Surface& coarse, Surface& fine);

/// The smooth surface of a reference: a cubic triangle (Vlachos and others 2001) over each triangle that the
/// reference was cut from (face column `origin`). It interpolates the vertices, with normals averaged (Max
/// 1999) on each side of borders and model edges (face column `model`), which become smooth curves where they
/// turn by less than 45 degrees. Straight lines and planes stay. No point is farther from the reference than
/// a fifth of its triangle's longest edge. Keeps a reference to the surface.
class CurvedSurface {
 public:
  explicit CurvedSurface(const Surface& reference);
  /// Returns the point above a place of the reference; at vertices, the vertex itself.
  Vec3 point(const Place& place) const;

 private:
  const Surface& reference_;
  Mesh whole_;                            ///< what the reference was cut from
  std::vector<int> below_;                ///< per triangle of the reference, that of whole_
  std::vector<std::array<Vec3, 2>> off_;  ///< per half-edge: its inner control points less its thirds
};

/// Moves the vertices of a mesh from the reference to the smooth surface, except those of triangles that then
/// intersect. Returns the number of vertices that stay.
int raise_vertices(LiftedMesh& mesh, const CurvedSurface& surface);

/// A point within edge a, b of a mesh, a < b.
struct MidPoint {
  int a, b;
  Vec3 point;
};

struct MidPoints {
  std::vector<MidPoint> points;  ///< one per edge, by a, then b
  int straight = 0;              ///< edges kept straight, since a triangle of second order would fold
};

/// Computes a node for every edge: its midpoint moved to the nearest point of the reference that a walk from
/// the ends reaches without crossing model edges (for borders and model edges: along the reference's), then
/// to `surface` unless that is null. All edges of triangles of second order that would fold keep their
/// midpoints. Throws: as opposite_halfedges.
MidPoints mid_points(const LiftedMesh& mesh, const Surface& reference, const CurvedSurface* surface);

}  // namespace meshpipe
