// SPDX-License-Identifier: BSD-3-Clause
// What a result is judged by: connectivity, quality, distance to the reference.
#pragma once
#include "lib/bvh.h"
#include "lib/mesh.h"

namespace meshpipe {

/// Counts that never throw, whatever the triangles are; the first culprit of each kind is a triangle, or -1.
struct Connectivity {
  int vertices = 0, edges = 0, faces = 0;       ///< vertices that are used
  int degenerate = 0, first_degenerate = -1;    ///< triangles with a repeated vertex
  int nonmanifold = 0, first_nonmanifold = -1;  ///< edges of more than two triangles
  int turned = 0, first_turned = -1;            ///< edges whose two triangles disagree on orientation
  int pinched = 0, first_pinched = -1;          ///< vertices whose triangles form more than one fan
  bool sound() const { return !(degenerate || nonmanifold || turned || pinched); }
  int components = 0, genus = 0, loops = 0;  ///< of a sound mesh
};
Connectivity connectivity_of(const Mesh& mesh);

struct Quality {
  double kappa_min = 0, kappa_p01 = 0, kappa_mean = 0;
  int worst = -1;                                           ///< the triangle with kappa_min
  double min_angle = 0, mean_min_angle = 0, max_angle = 0;  ///< degrees
  /// Edge lengths in units of the size field (its mean over the edge), or of the mean edge.
  double edge_min = 0, edge_mean = 0, edge_max = 0, edge_deviation = 0;
  double valence567 = 0;             ///< share of the inner vertices with 5, 6 or 7 neighbours
  std::vector<int> kappa_histogram;  ///< 50 bins over [0, 1]
};
/// `size` per vertex, or empty.
Quality quality_of(const Mesh& mesh, const std::vector<double>& size);

/// Distances over the reference's diagonal. Each triangle is cut into equal ones whose centres are the
/// samples, its corners are samples too; the true Hausdorff distance lies between hausdorff and hausdorff +
/// bound, since distance grows by no more than the way gone.
struct Distance {
  double hausdorff = 0, mean = 0, rms = 0, bound = 0;
  double to_reference = 0, to_mesh = 0;  ///< one-sided: of the mesh's points, of the reference's points
  Vec3 place;                            ///< the sample with the largest distance
  double boundary = 0;  ///< Hausdorff distance of the border curves; infinite if only one has any
};
/// Two-sided: the worse of both directions. Deterministic at any thread count. samples: about this many
/// points a side.
Distance distance_between(const Mesh& reference, const Mesh& mesh, int samples = 200000);
/// The same with the trees at hand.
Distance distance_between(const Mesh& reference, const Bvh& reference_tree, const Mesh& mesh,
                          const Bvh& mesh_tree, int samples);

}  // namespace meshpipe
