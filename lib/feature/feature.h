// SPDX-License-Identifier: BSD-3-Clause
// Model edges: patch borders, given lines, and the creases that are design, not noise.
#pragma once
#include <string>
#include <vector>

#include "lib/core/topology.h"
#include "lib/feature/curvature.h"
#include "lib/feature/merge.h"
#include "lib/feature/model_edges.h"

namespace meshpipe {

struct FeatureOptions {
  enum { automatic, angles, none } mode = automatic;
  double strong = 40, weak = 20;  ///< degrees; a crease starts above the one and continues above the other
  double size = 0;                ///< target edge length; 0: the mean edge length
  /// First and last of the patches that cap ends: their borders do not show that the rest is designed.
  int first_cap = 0, last_cap = -1;
  bool again = false;  ///< components that have creases as model edges now look designed
};

/// Sets mode and angles from "auto", "none", "A" or "A,B" (degrees; B is A / 2 by default). Throws: BadUsage.
void parse_angles(const std::string& text, FeatureOptions& options);

struct FeatureReport {
  int model_edges = 0, patch_edges = 0, given_edges = 0, crease_edges = 0, corners = 0;
  int slivers = 0;  ///< triangles too thin for the target edge length to make a crease of their own
};

/// Sets face column `model`: bit i of triangle t marks the edge from corner i to i+1, on both sides. Model
/// edges are borders between patches (column `patch`) and creases: in automatic mode those of components that
/// look designed (keep_designed), without short chains and, unless a polyhedron has them, rough open ones.
/// `before`: null, or per triangle the patch before some were merged; no crease follows a border that
/// vanished unless it bends sharply. `given`: null, or per half-edge the number of a line that is a model
/// edge in any mode, or -1.
FeatureReport mark_features(CutSurface surface, const FeatureOptions& options,
                            const std::vector<int>* before = nullptr,
                            const std::vector<int>* given = nullptr);
inline FeatureReport mark_features(Surface& surface, const FeatureOptions& options) {
  std::vector<int> opposite = opposite_halfedges(surface);
  return mark_features({surface, opposite}, options);
}

/// Returns a unit normal per triangle: its own, unless its height is below `thin` (a length) and a twentieth
/// of its length, no connected other one is in its plane, and it is in a band of such triangles whose centers
/// are at most `thin` / 2 from the nearer side; or unless it is too thin for single-precision coordinates
/// (`thin` 0: only these). Those get the normal of the nearest other triangle across them.
std::vector<Vec3> side_normals(const Connectivity& surface, double thin);

}  // namespace meshpipe
