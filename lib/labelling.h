// SPDX-License-Identifier: BSD-3-Clause
// Labels for the triangles of a connected surface, each of which maps to the plane.
#pragma once
#include <cstdint>
#include <vector>

#include "lib/cells.h"
#include "lib/partition.h"
#include "lib/regions.h"

namespace meshpipe {

/// An edge that bends by more (40 degrees) is a crease, marked or not.
constexpr double sharp_edge = 40 * 3.14159265358979 / 180;

/// A component of a surface with what its graph is made of: cells joined across edges, weighed by their
/// length.
struct Component {
  Mesh mesh;
  std::vector<std::uint8_t> model;  ///< face column, or empty
  std::vector<int> opposite;
  std::vector<double> area;  ///< of each triangle
  std::vector<int> weight;   ///< of each half-edge, as in the graph: the cost of a cut along it
  Cells cells;
  Region whole;
  int of_fine = 0;   ///< triangles of the component that this is a coarse model of, or 0
  double share = 0;  ///< of the work on the whole surface (lib/progress.h)
};

/// Without weights and cells, which are made when they are needed.
Component make_component(Mesh mesh, std::vector<std::uint8_t> model, std::vector<int> opposite,
                         const Region& whole);

/// How a labelling compares: fewer charts in the end first, then the cheaper cut.
struct Labelling {
  std::vector<int> label;     ///< 0..parts-1
  int burden = 0, parts = 0;  ///< charts it will come to, as foreseen
  std::int64_t cost = 0;
  bool operator<(const Labelling& o) const;
};

/// Tries several numbers of parts, balances and seeds; those of a large component on a coarse model of it.
/// Every label is edge-connected, pinched nowhere, and has genus 0 and a boundary. No parts if none is found.
Labelling best_labelling(Component& c, const PartitionOptions& options);

/// Cuts parts of too many triangles, with some room for those that smoothing adds. No parts if it cannot.
void bound_faces(Component& c, Labelling& l, int max_faces, int seed);

}  // namespace meshpipe
