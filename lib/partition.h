// SPDX-License-Identifier: BSD-3-Clause
// Multilevel partitioning of a surface until every part has genus 0 and a boundary (the paper's section 4,
// step 1).
#pragma once
#include <string>

#include "lib/mesh.h"

namespace meshpipe {

struct PartitionOptions {
  bool homology = false;  ///< cuts along handles are tried as well (lib/handles.h); else only if METIS's
                          ///< labellings come to more than genus + 2 charts
  int seed = 1;
  int max_faces = 0;  ///< bound on the triangles of a part; 0: 100 000 for a component of more than 300 000,
                      ///< so that solves stay near linear, else none
  double snap = 0.1;  ///< of cut_by_scalar_field
};

/// Sets face columns `part` (0..n-1) and `origin` (where missing) so that every part is edge-connected,
/// vertex-manifold, touches itself nowhere, has genus 0 and at least one boundary loop; as few parts as it
/// finds, then the shortest and smoothest cut. Interfaces are smoothed by cutting through triangles, so
/// triangles and vertices may be added (see lib/cut.h); the surface as a set of points stays. Components are
/// treated one by one. Model edges (face column `model`) attract cuts. Precondition: an oriented manifold
/// without pinched vertices (NotAdmissible otherwise). Throws GoalMissed if a part cannot be made admissible.
/// Returns the number of parts; `opposite`, if given, receives the result's (lib/topology.h).
int partition_to_disks(Surface& surface, const PartitionOptions& options = {},
                       std::vector<int>* opposite = nullptr);

/// Checks the rule of formats/mply.md on parts; returns an empty string, or what is wrong and where.
std::string part_fault(const Surface& surface);
std::string part_fault(const Surface& surface, const std::vector<int>& opposite);

/// How long and how straight the interfaces between the parts are.
struct Interfaces {
  double length = 0;  ///< over the diagonal of the surface's bounding box
  /// The 90 % quantile and the largest of the angles by which successive edges turn on the surface (geodesic
  /// curvature: pi |left - right| / (left + right) by the angles of the triangles on both sides), in degrees;
  /// without junctions and the vertices of interface edges along creases (model edges, and those sharper than
  /// 40 degrees).
  double turning_angle = 0, largest_angle = 0;
  int junctions = 0;  ///< vertices with three or more interface edges
};
Interfaces measure_interfaces(const Surface& surface, const std::vector<int>& opposite);
Interfaces measure_interfaces(const Surface& surface);

}  // namespace meshpipe
