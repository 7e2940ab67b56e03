// SPDX-License-Identifier: BSD-3-Clause
// How far two surfaces are apart.
#pragma once
#include "lib/bvh.h"
#include "lib/mesh.h"

namespace meshpipe {

/// Lengths are over the diagonal of the reference's bounding box.
struct Distance {
  /// Two-sided Hausdorff distance: the largest of the distances found, which is at most the true one; the
  /// true one is at most `hausdorff + bound`.
  double hausdorff = 0, bound = 0;
  double to_reference = 0, to_mesh = 0;  ///< one-sided: of the mesh's points, of the reference's points
  Vec3 place;                            ///< the point with the largest distance
  double mean = 0, rms = 0;              ///< over the area; the worse of both sides
};

/// Mean and RMS are taken from points spread evenly over each surface, `samples` at most on each. What is
/// known from them is the start of a branch and bound: a ball of radius r about a point that is d away is at
/// most d + r away; a triangle is no farther from any one triangle of the other surface than its corners are,
/// nor than the part of the other surface that covers it, seen along its normal. What may be farther than the
/// farthest point known is divided, down to a bound of 5 % or 1e-4 of the diagonal, with at most 8 `samples`
/// more points a side. Deterministic at any thread count. Precondition: both have triangles.
Distance distance_between(const Mesh& reference, const Bvh& reference_tree, const Mesh& mesh,
                          const Bvh& mesh_tree, int samples = 10000);

/// Distances of the mesh's vertices from a surface (0 for vertices that no triangle uses). `mesh_tree` is the
/// mesh's, `tree` the surface's.
std::vector<double> vertex_distances(const Mesh& mesh, const Bvh& mesh_tree, const Bvh& tree);

/// How far the two surfaces are apart at every triangle of the mesh, a length: the largest distance of its
/// centre and sides' middles from the reference, and of the reference's vertices, centres and sides' middles
/// from it, where it is the nearest.
std::vector<double> triangle_errors(const Mesh& reference, const Bvh& reference_tree, const Mesh& mesh,
                                    const Bvh& mesh_tree);

/// The size (per vertex) that brings the mesh nearer to within `limit` of the reference: smaller in
/// proportion where a triangle's error is larger, by no more than a factor of 4. (Where a surface is smooth
/// the error goes with the square of the size, but on its ridges and tips only with the size.) Other sizes
/// stay.
std::vector<double> refined_size(const Mesh& mesh, const std::vector<double>& size,
                                 const std::vector<double>& errors, double limit);

/// Edges as triangles (a, b, b), which a Bvh takes as the segments that they are: half-edges for which
/// wanted(h). Linear.
template <class Wanted>
void add_segments(Mesh& segments, const Mesh& mesh, const Wanted& wanted) {
  for (int h = 0; h < 3 * (int)mesh.tris.size(); ++h) {
    if (!wanted(h)) continue;
    const int n = (int)segments.points.size();
    segments.points.push_back(mesh.points[origin(mesh.tris, h)]);
    segments.points.push_back(mesh.points[target(mesh.tris, h)]);
    segments.tris.push_back({n, n + 1, n + 1});
  }
}

/// Two-sided Hausdorff distance of two sets of segments (a, b, b), from nine points a segment: a length. 0 if
/// both are empty, infinite if one is.
double curve_distance(const Mesh& a, const Mesh& b);

}  // namespace meshpipe
