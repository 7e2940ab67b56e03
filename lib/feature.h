// SPDX-License-Identifier: BSD-3-Clause
// Model edges: patch borders and the creases that are design, not noise.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

struct FeatureOptions {
  enum { automatic, angles, none } mode = automatic;
  double strong = 40, weak = 20;  ///< degrees, for the modes with creases
  double size = 0;                ///< target edge length h; 0: the mean edge length
};

/// Unit normals of the triangles. A triangle so thin that rounding of single-precision coordinates turns its
/// normal has that of the neighbour across its longest edge, in whose plane it lies; so has one that is
/// thinner than `thin` and than a twentieth of its length. Two of them that face each other, the halves of a
/// strip, have those of the neighbours across their other long edges if `thin` is not 0.
std::vector<Vec3> sound_normals(const Mesh& mesh, const std::vector<int>& opposite, double thin = 0);

struct FeatureReport {
  int model_edges = 0, patch_edges = 0, given_edges = 0, crease_edges = 0, corners = 0;
  int slivers = 0;  ///< triangles too thin for the target edge length to make a crease of their own
};

/// Sets face column `model`: bit i of triangle t is set if the edge from corner i to i+1 is a model edge (set
/// on both sides). Borders between patches (face column `patch`) are always model edges; the mesh border
/// needs no bit. A crease starts at edges above the strong angle and goes on from its free ends along weak
/// ones; the angles are 40 and 20 in automatic mode. There, chains that are not closed and end freely are
/// dropped, and a component keeps its creases only if it looks designed: at least half of its strong edges,
/// by length, are between patches or in chains that turn smoothly and are longer than five mean edges of the
/// input; or edges between weak and strong have less than a twentieth of the length of the strong ones, and
/// the creases are more than 1.5 h apart on average (area over length). Otherwise free ends are dropped if
/// shorter than 3 h. Pieces below 3 h are dropped in automatic mode. `before`, if not null, holds the patches
/// before some were merged: in automatic mode no crease runs along a border that vanished, unless it bends by
/// more than 60 degrees. `given`, if not null, marks half-edges (both, where there are two) that are model
/// edges in any mode, but for borders that vanished. Throws like opposite_halfedges.
FeatureReport mark_features(Surface& surface, const FeatureOptions& options,
                            const std::vector<int>* before = nullptr,
                            const std::vector<char>* given = nullptr);

}  // namespace meshpipe
