// SPDX-License-Identifier: BSD-3-Clause
// Distances between two surfaces.
#pragma once
#include <span>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Distances between the surfaces at each triangle of the mesh, in units of the distance allowed there.
struct Deviation {
  std::vector<double> allowed;  ///< per triangle, as given; empty: any
  std::vector<double> ratio;    ///< per triangle, the largest found
  double worst = 0;             ///< the largest of them
  int triangle = -1;            ///< where: the one it is measured from or to
  Vec3 place;
};

/// Lengths over the diagonal of the reference's bounding box.
struct Distance {
  double hausdorff = 0;      ///< two-sided, the largest distance found: a lower bound
  double bound = 0;          ///< the true distance is at most hausdorff + bound
  double to_reference = 0;   ///< one-sided: from the mesh to the reference
  double to_mesh = 0;        ///< one-sided: from the reference to the mesh
  Vec3 place;                ///< the point with the largest distance
  double mean = 0, rms = 0;  ///< over the area; the worse of both sides
  Deviation deviation;
};

/// What distance_from finds; lengths.
struct OneWay {
  double largest = 0;        ///< found
  Vec3 place;                ///< of it
  double upper = 0;          ///< no point is farther
  double mean = 0, rms = 0;  ///< over the area
  Deviation deviation;       ///< without `allowed`
};
struct OneWayOptions {
  int samples, budget;   ///< points to measure the mean with, and to bound the distance
  double diagonal;       ///< of the reference
  double most;           ///< a length: a distance below it is bounded by it; 0: none
  bool allowed_of_from;  ///< is `allowed` per triangle of the surface that is measured from?
};
/// Measures how far these triangles of a surface, in an order in which neighbors are close together, are from
/// another surface. `allowed`: the distance per triangle of one of the surfaces, see OneWayOptions; empty:
/// any. Requires: both have triangles.
OneWay distance_from(const Mesh& from, std::span<const int> triangles, const Connectivity& to,
                     const Bvh& to_tree, const OneWayOptions& options, std::span<const double> allowed);

/// Computes mean and RMS from at most `samples` evenly spread points on each surface, and bounds the
/// Hausdorff distance by branch and bound with at most 8 `samples` more points per side: to 5 % or to 1e-4 of
/// the diagonal, where these suffice. Bounds it also by `allowed`, a length per triangle of the mesh (empty:
/// none), and by `most`, over the diagonal: a distance below it is bounded only by it, with up to 64
/// `samples` (infinity: none). The same at any number of threads. Requires: both have triangles.
Distance distance_between(const Connectivity& reference, const Bvh& reference_tree, const Connectivity& mesh,
                          const Bvh& mesh_tree, int samples, std::span<const double> allowed, double most);

/// Returns per vertex of the mesh its distance from a surface, of which `tree` is; 0 for vertices not of
/// these triangles. Faster if neighbors in space are close in the list, as in Bvh::order.
std::vector<double> vertex_distances(const Mesh& mesh, std::span<const int> triangles,
                                     const Connectivity& surface, const Bvh& tree);

/// Returns per triangle of the mesh the distance of the surfaces there, a length: the largest one of its
/// seven sample points (corners, edge midpoints, centroid) from the reference, and of those sample points of
/// the reference to which it is the nearest triangle.
std::vector<double> triangle_errors(const Mesh& reference, const Bvh& reference_tree, const Mesh& mesh,
                                    const Bvh& mesh_tree);

/// Returns the sizes per vertex, reduced where a triangle's error is above 0.6 `limit`, in proportion to the
/// error and at most fourfold, and at the neighbors. (The error of a smooth surface falls with the square of
/// the size, but on ridges only linearly.)
std::vector<double> refined_size(const Mesh& mesh, const std::vector<double>& size,
                                 const std::vector<double>& errors, double limit);

/// Appends the half-edges h with wanted(h) as degenerate triangles (a, b, b), which a Bvh treats as segments.
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

/// Returns the two-sided Hausdorff distance of two sets of segments (a, b, b), a length, from nine points per
/// segment. 0 if both are empty, infinite if one is.
double curve_distance(const Mesh& a, const Mesh& b);

}  // namespace meshpipe
