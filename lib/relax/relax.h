// SPDX-License-Identifier: BSD-3-Clause
// Optimization of a mesh on its reference surface, across every interface that is not a model edge.
#pragma once
#include <utility>

#include "lib/lift/lift.h"
#include "lib/solids/solids.h"

namespace meshpipe {

struct RelaxOptions {
  int sweeps = 4;
  /// Triangle count of the result; refinement in narrow places is taken from the rest. 0: as the size field
  /// asks, and narrow places have more.
  double target_triangles = 0;
  bool keep_border = false;  ///< no new vertex on the border
  bool sheets_meet = false;  ///< border vertices at the same place, to the last bit, are copies of one
  /// Meshes of more than four times this number of triangles are optimized in tiles of at most as many, in
  /// parallel. With 250,000 a tile takes about 75 MB, and the seams are 7 % of all.
  int tile = 250000;
  /// The regions on both sides of each patch. Vertices inside of sheets are moved off the reference, by at
  /// most 0.08 edges, to bring the volumes near to those of the reference.
  std::vector<SheetPatch> sheets;
};

struct RelaxCounts {
  int splits = 0, collapses = 0, flips = 0, moves = 0;
  int corners_merged = 0;  ///< corners of the model merged with one much nearer than the size
};

struct RelaxReport : RelaxCounts {
  /// Pairs of triangles of the result that intersect where the reference does not, sorted.
  std::vector<std::pair<int, int>> intersections;
  int intersections_of_reference = 0;  ///< pairs of the result that intersect where the reference does, too
  double kappa_min = 0, kappa_mean = 0;
  double volume_error = 0;  ///< of regions between sheets: the largest relative difference of a volume
  int tries = 1;            ///< optimizations that it took to meet the target count, at most 4
};

/// Flips, collapses, splits and moves until the mesh is regular, judged in space. Vertices stay on the
/// reference; borders, model edges and corners stay; vertices of interface lines (line_kind[line] ==
/// interface_line) are free.
///   reference: vertex column `size` (without: the mesh's own sizes), face column `model` (without: no edges)
///   corner: per vertex of the reference, 1 where a line has a corner that stays, unless another is much
///   nearer
///     than the size; empty: only ends and junctions of lines stay
/// Returns: the same bytes at any number of threads.
RelaxReport relax(LiftedMesh& mesh, const Surface& reference, const std::vector<int>& line_kind,
                  const std::vector<char>& corner = {}, const RelaxOptions& options = {});

}  // namespace meshpipe
