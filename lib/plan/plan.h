// SPDX-License-Identifier: BSD-3-Clause
// The cutting planner: decides what is cut so that every part maps to the plane, and what is cut again once a
// map has failed. All of its limits are in lib/partition/thresholds.h.
#pragma once
#include <vector>

#include "lib/core/chart.h"
#include "lib/core/mesh.h"
#include "lib/core/topology.h"
#include "lib/multiscale/multiscale.h"
#include "lib/param/param.h"

namespace meshpipe {

struct PartitionOptions {
  bool homology = false;  ///< try cuts along handles (lib/partition/handles.h) even if METIS does well
  int seed = 1;
  int max_faces = 0;  ///< most triangles of a part; 0: as lib/partition/thresholds.h says
};

/// Sets face columns `part` (0..n-1) and `origin` (where missing) so that every part is edge-connected,
/// touches itself nowhere, has genus 0 and a border. Parts are the faces that model edges (face column
/// `model`) bound; those that do not map to the plane are cut through triangles, into as few parts as it
/// finds, then by the shortest and smoothest line. `opposite`, if given, receives the result's opposite
/// half-edges. Returns the number of parts.
/// Requires: an oriented manifold. Throws: NotAdmissible; GoalMissed if there is no such cut.
int partition_to_disks(Surface& surface, const PartitionOptions& options = {},
                       std::vector<int>* opposite = nullptr);

struct MultiscaleOptions {
  double max_aspect = 4;   ///< eta_max of the paper's eq. (5)
  int most_parts = 0;      ///< more are a failure (0: any number)
  bool keep_maps = false;  ///< fill MultiscaleCut::maps
};

/// One cut that was made.
struct MultiscaleCut {
  int part = 0;  ///< whose number its first half keeps
  /// Numbered as in the result; cut again themselves if they are the `part` of a later cut.
  int halves[2] = {0, 0};
  double eta = 0;     ///< eta_geo before
  int levels = 0;     ///< of Laplace maps
  double length = 0;  ///< of the cut line, over the diagonal of the part's bounding box
  CutMaps maps = {};  ///< with keep_maps
};

/// Cuts every part (face column `part`) whose geodesic aspect ratio exceeds max_aspect, recursively, then
/// joins halves to neighbors where the union is admissible. If triangles are in no part (-1), they are left
/// alone and nothing is joined; a part that cuts do not make shorter stays. Returns the number of parts.
/// Receive, if given: `cuts` the cuts in order, `topology` and `opposite` the result's; these two may bring
/// what is known before.
/// Requires: parts of genus 0 with a border. Throws: NotAdmissible; GoalMissed beyond most_parts.
int multiscale_cut(Surface& surface, const MultiscaleOptions& options = {},
                   std::vector<MultiscaleCut>* cuts = nullptr, std::vector<Topology>* topology = nullptr,
                   std::vector<int>* opposite = nullptr);

/// Maps every part of the surface (face column `part`, 0..n_parts-1) to the plane. A part whose map fails, or
/// is worse than lib/partition/thresholds.h allows, is cut along its limbs or by a short line, and its pieces
/// are mapped (not with options.strict). Cuts append vertices, split triangles and rewrite column `part`;
/// circle maps first split triangles with two edges on the longest loop (lib/param/ears.h). `alone`: such
/// parts stay without a map; `known`: the maps made so, with their rows of `reports`. Returns the charts, and
/// one row of `reports` per part. Throws: GoalMissed if a part has no one-to-one map.
std::vector<Chart> map_surface(Surface& surface, int n_parts, const ParamOptions& options,
                               std::vector<ParamReport>& reports, std::vector<Chart> known = {},
                               bool alone = false);

}  // namespace meshpipe
