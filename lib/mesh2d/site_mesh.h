// SPDX-License-Identifier: BSD-3-Clause
// The common ground of the three plane meshers: a triangulation in the plane whose vertices lie on the
// surface, and operations on it that are judged in space.
#pragma once
#include "lib/core/cdt.h"
#include "lib/mesh2d/plane_metric.h"

namespace meshpipe {

/// A triangulation whose vertices know where on the surface they are.
struct SiteMesh {
  Cdt cdt;
  std::vector<Site> site;
  int line_points;          ///< vertices below this number, on lines or to be kept, do not move
  std::size_t most_points;  ///< insertion beyond this number of points is refused
  Cavity cavity;            ///< its fan() is that of the last vertex inserted
};

/// How near a new vertex may be to others, over the size at it.
struct Spacing {
  double vertex;  ///< no new edge is shorter
  double line;    ///< no fixed edge that it sees is nearer
};

/// Inserts a vertex at p, known to be at `there`, by Bowyer and Watson's cavity in the metric there; p lies
/// in triangle t. The new triangles are mesh.cavity.fan().
/// Returns: false, with only cavity.rim() changed, if p is on a vertex or fixed edge or too near to others.
/// Throws: GoalMissed if the mesh has most_points already.
bool insert_site(SiteMesh& mesh, Vec2 p, const Site& there, int t, Spacing spacing);

/// Inserts a vertex in the middle of a free half-edge, as measured in space, if the two halves together are
/// longer than `longest` sizes (across a bend of the surface they are longer than the edge).
/// Returns: whether the vertex was inserted.
bool split_long_edge(SiteMesh& mesh, const SizeMetric& field, int h, double longest);

/// A vertex of the chart, in its triangle `face`, that triangle `triangle` of a mesh covers.
struct Missed {
  Vec2 p;
  int face, triangle;
};

/// Returns vertices of the chart that the mesh misses, at most one per triangle, the farthest: the triangle
/// that covers it in the plane is half a size away in space, and covers more of the surface than two
/// triangles of that size. Short edges are no proof: a ball behind a narrow neck may lie in one triangle.
std::vector<Missed> missed_vertices(const SiteMesh& mesh, const SizeMetric& field);

/// Flips edges, starting with the half-edges in `todo` (emptied), until the angles opposite to each sum to
/// at most pi in space. Ends always.
void flip_to_delaunay(SiteMesh& mesh, std::vector<int>& todo);
/// The same for all edges.
void flip_to_delaunay(SiteMesh& mesh);

/// Moves inner vertices between their neighbors, `sweeps` times, with flips, unless unwanted, before, between
/// and after.
void smooth_in_plane(SiteMesh& mesh, const SizeMetric& field, int sweeps, bool flips = true);

}  // namespace meshpipe
