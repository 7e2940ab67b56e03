// SPDX-License-Identifier: BSD-3-Clause
// Labels for the triangles of a connected surface, each of which maps to the plane.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "lib/core/regions.h"
#include "lib/partition/aggregates.h"

namespace meshpipe {

/// A component of a surface with what its graph is made of: aggregates joined across edges, weighed by
/// their length.
struct Component {
  Mesh mesh;
  std::vector<int> opposite;
  std::vector<double> area;  ///< of each triangle
  std::vector<int> weight;   ///< of each half-edge, as in the graph: the cost of a cut along it
  Aggregates aggregates;
  Region whole;
  int of_fine = 0;   ///< triangles of the component that this is a coarse model of, or 0
  double share = 0;  ///< of the work on the whole surface (lib/core/progress.h)
};

/// Without weights and aggregates, which are made when they are needed.
Component make_component(ConnectedPart part, const Region& whole);

/// How a labeling compares: fewer parts in the end first, then the cheaper cut.
struct Labeling {
  std::vector<int> label;  ///< 0..parts-1
  int parts = 0;
  int cut_parts = 0;  ///< with those that are too long counted twice, since they will be cut
  std::int64_t cost = 0;
  bool operator<(const Labeling& o) const {
    return std::pair(cut_parts, cost) < std::pair(o.cut_parts, o.cost);
  }
};

/// Tries several numbers of parts, balances and seeds; those of a large component on a coarse model of it.
/// With `homology`, cuts along handles (lib/partition/handles.h) too; else only if METIS's labelings have
/// more than genus + 2 parts. Every label is edge-connected, pinched nowhere, and has genus 0 and a border.
/// No parts if none is found.
Labeling best_labeling(Component& c, bool homology, int seed);

/// Cuts parts of too many triangles, with a margin for those that smoothing adds. No parts if it cannot.
void bound_faces(Component& c, Labeling& l, int max_faces, int seed);

}  // namespace meshpipe
