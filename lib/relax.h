// SPDX-License-Identifier: BSD-3-Clause
// Optimisation of a mesh on its reference surface, across every interface that is not a model edge.
#pragma once
#include <utility>

#include "lib/lift.h"

namespace meshpipe {

struct RelaxOptions {
  int sweeps = 4;
  /// So many in the end: what narrow places take more, the rest has less. 0: what the size field asks for,
  /// and narrow places more.
  double target_triangles = 0;
  bool keep_border = false;  ///< no new vertex on the border
};

struct RelaxReport {
  int splits = 0, collapses = 0, flips = 0, moves = 0;
  int corners_merged = 0;  ///< corners of the model that went to another, which was much nearer than the size
  /// Pairs of triangles left in the result that intersect where the reference does not, sorted.
  std::vector<std::pair<int, int>> intersections;
  int intersections_of_reference = 0;  ///< pairs of the result where the reference intersects, too
  double kappa_min = 0, kappa_mean = 0;
};

/// Flips, collapses, splits and moves until the mesh is regular, judged in space. Every vertex stays on the
/// reference: moves walk over its triangles from the vertex's place. Borders, model edges and corners keep
/// their chains; vertices of interface lines (line_kind[line] == interface_line) are free.
///   reference: with a vertex column `size` (else the mesh's own sizes) and a face column `model` (else none)
///   corner: per vertex of the reference, where a border or model edge has a corner that stays, unless
///   another is much nearer than the size; empty: only ends and junctions stay
/// The same bytes at any number of threads.
RelaxReport relax(LiftedMesh& mesh, const Surface& reference, const std::vector<int>& line_kind,
                  const std::vector<char>& corner = {}, const RelaxOptions& options = {});

}  // namespace meshpipe
