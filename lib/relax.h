// SPDX-License-Identifier: BSD-3-Clause
// Optimisation of a mesh on its reference surface, across every interface that is not a model edge.
#pragma once
#include "lib/lift.h"

namespace meshpipe {

struct RelaxOptions {
  int sweeps = 8;
  double target_triangles = 0;  ///< 0: what the size field asks for
};

struct RelaxReport {
  int splits = 0, collapses = 0, flips = 0, moves = 0;
  int intersections = 0;  ///< pairs left in the result
  double kappa_min = 0, kappa_mean = 0;
};

/// Flips, collapses, splits and moves until the mesh is regular, judged in space. Every vertex stays on the
/// reference: moves walk over its triangles from the vertex's place. Borders, model edges and corners keep
/// their chains; vertices of interface lines (line_kind[line] == interface_line) are free. Deterministic.
RelaxReport relax(LiftedMesh& mesh, const Surface& reference, const std::vector<int>& line_kind,
                  const RelaxOptions& options = {});

}  // namespace meshpipe
