// SPDX-License-Identifier: BSD-3-Clause
// What the three plane meshers share: a triangulation in the plane whose vertices lie on the surface, and the
// operations on it that are judged in space.
#pragma once
#include "lib/cdt.h"
#include "lib/plane_metric.h"

namespace meshpipe {

/// A triangulation whose vertices know where on the surface they are.
struct SiteMesh {
  Cdt cdt;
  std::vector<Site> site;
  int line_points;  ///< vertices below this number do not move
};

/// How near a new vertex may be to others, over the size at it.
struct Spacing {
  double vertex;  ///< no new edge is shorter
  double line;    ///< no fixed edge that it sees is nearer
};

/// Inserts a vertex at p, known to be at `there`, by Bowyer and Watson's cavity in the metric there; p lies
/// in triangle t. False, and nothing is changed, if p is on a vertex or a fixed edge or too near to what is
/// there; else the new triangles are cdt.fan().
bool insert_site(SiteMesh& mesh, Vec2 p, const Site& there, int t, Spacing spacing);

/// Inserts a vertex in the middle of a free half-edge, as measured in space, if the way over it is longer
/// than `longest` sizes (an edge that spans a bend of the surface is longer than its chord). False if nothing
/// was changed.
bool split_long_edge(SiteMesh& mesh, const SizeMetric& field, int h, double longest);

/// A vertex of the chart, in its triangle `face`, that triangle `triangle` of a mesh covers.
struct Missed {
  Vec2 p;
  int face, triangle;
};

/// Vertices of the chart that the mesh misses: the triangle that covers one in the plane is half a size away
/// in space, and covers more of the surface than two triangles of that size. Its edges do not tell: a ball
/// behind a narrow neck may lie in one triangle with short edges. At most one vertex a triangle, the
/// farthest.
std::vector<Missed> missed_vertices(const SiteMesh& mesh, const SizeMetric& field);

/// Flips edges, starting with the half-edges in `todo` (emptied), until the angles that look at each sum to
/// at most pi in space. Ends always.
void flip_to_delaunay(SiteMesh& mesh, std::vector<int>& todo);
/// The same for all edges.
void flip_to_delaunay(SiteMesh& mesh);

/// Moves inner vertices between their neighbours, `sweeps` times, with flips before, between and after.
void smooth_in_plane(SiteMesh& mesh, const SizeMetric& field, int sweeps);

}  // namespace meshpipe
