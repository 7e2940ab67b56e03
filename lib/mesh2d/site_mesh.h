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

/// Of a vertex that is needed where an edge is much too long, or the mesh misses what is this far away.
constexpr Spacing least_spacing{0.5, 0.3};

/// Inserts a vertex at p, which lies in triangle t and on the surface at `there`, by Bowyer and Watson's
/// cavity in the metric there. The new triangles are mesh.cavity.fan(). Returns false, and changes only
/// `mesh.cavity`, if p is on a vertex or fixed edge, or too near to others. Throws: GoalMissed if the mesh
/// already has most_points.
bool insert_site(SiteMesh& mesh, Vec2 p, const Site& there, int t, Spacing spacing);

/// Inserts a vertex in the middle, in space, of free half-edge h if its two halves together are longer than
/// `longest` times the size there (across a bend they are longer than the edge). Returns whether it did.
bool split_long_edge(SiteMesh& mesh, const SizeMetric& field, int h, double longest);

/// A vertex of the chart, at p, in its triangle `face`, that triangle `triangle` of the mesh covers.
struct Missed {
  Vec2 p;
  int face, triangle;
};

/// Returns vertices of the chart that the mesh misses, per triangle the one farthest from its corners: where
/// a triangle covers a vertex in the plane that is half a size away from it in space, and covers more of the
/// surface than two triangles of that size. Short edges prove nothing: a ball behind a narrow neck may lie in
/// one triangle.
std::vector<Missed> missed_vertices(const SiteMesh& mesh, const SizeMetric& field);

/// Flips free edges, starting with the half-edges in `todo` (emptied), until the two angles in space opposite
/// to every edge sum to at most pi, or ten times as many were tried as were in `todo`.
void flip_to_delaunay(SiteMesh& mesh, std::vector<int>& todo);
/// Flips like the other flip_to_delaunay, starting with all edges.
void flip_to_delaunay(SiteMesh& mesh);

/// Moves inner vertices towards the mean of their neighbors, `sweeps` times, where no triangle folds or
/// becomes a needle; with `flips`, flip_to_delaunay comes before and after each sweep.
void smooth_in_plane(SiteMesh& mesh, const SizeMetric& field, int sweeps, bool flips = true);

}  // namespace meshpipe
