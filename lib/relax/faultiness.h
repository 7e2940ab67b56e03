// SPDX-License-Identifier: BSD-3-Clause
// How far a patch is from a mesh without faults; for lib/relax/ only.
#pragma once
#include "lib/relax/faults.h"

namespace meshpipe {

/// Triangles around a patch, which stay as they are, each with points of its own, and their boxes.
struct Surroundings {
  Mesh mesh{};
  std::vector<Box> box{};
};

/// Returns the triangles that a change of these might intersect (rules::reach_of_patch, with this mean size);
/// none if they are too many for each trial to look at all of them (rules::most_around). Requires: there are
/// triangles, and the tree is up to date.
Surroundings surroundings(const State& s, const MeshTree& tree, std::vector<int> triangles, double mean);

/// What is around a patch, the patch as it was first, and what was found of it: an edit changes few of its
/// triangles. Pairs are of the patch; `meets`: what pairs with the surroundings add, per triangle.
struct PatchBefore {
  Surroundings around{};
  Mesh mesh{};
  std::vector<double> deviation{}, meets{};
  std::vector<std::pair<int, int>> pairs{};

  /// Returns whether triangle t of this mesh is as it was.
  bool has(const Mesh& now, int t) const;
};

/// Adds to `sum` how far a patch is from good: folds and pairs that intersect where the reference does not,
/// also with the surroundings, distances over what is bearable, there and from the `missed` places of the
/// reference, and 1/kappa of needles. Ends with what it has when that is over `bound`. `mean`: the mean size.
/// The first call, alone and without a bound, makes its patch `before`; later ones may be at the same time.
double with_faultiness(const State& s, double sum, double bound, const std::vector<Vec3>& missed, double mean,
                       Known& known, PatchBefore& before);

/// Returns what triangles_intersect does, without a copy of the mesh; corners at the same place are one.
bool intersect(const State& s, int t, int u);

}  // namespace meshpipe
