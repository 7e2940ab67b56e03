// SPDX-License-Identifier: BSD-3-Clause
// Labels for the triangles of a connected surface, each of which maps to the plane.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "lib/core/regions.h"
#include "lib/partition/aggregates.h"

namespace meshpipe {

/// A component of a surface, and its graph: aggregates joined by edges, weighted by length.
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

/// Makes a component that is the region `whole`. Weights and aggregates are made when they are needed.
Component make_component(ConnectedPart part, const Region& whole);

/// A labeling of triangles; less is better: fewer parts in the end, then the cheaper cut.
struct Labeling {
  std::vector<int> label;  ///< 0..parts-1
  int parts = 0;
  int cut_parts = 0;  ///< with those that are too long counted twice, since they will be cut
  std::int64_t cost = 0;
  bool operator<(const Labeling& o) const {
    return std::pair(cut_parts, cost) < std::pair(o.cut_parts, o.cost);
  }
};

/// Returns the best of labelings for several numbers of parts, balances and seeds, made on a coarse model if
/// the component is large. Labelings by cuts along handles (lib/partition/handles.h) are tried with
/// `homology`, or if METIS's have more than genus + 2 parts. Every label is edge-connected, pinched nowhere,
/// and has genus 0 and a border. No parts if none is found.
Labeling best_labeling(Component& c, bool homology, int seed);

/// Cuts the parts of a labeling until none has more than 0.9 max_faces triangles (smoothing adds some).
/// l.parts becomes 0 if that fails.
void bound_faces(Component& c, Labeling& l, int max_faces, int seed);

}  // namespace meshpipe
