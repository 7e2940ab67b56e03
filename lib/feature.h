// SPDX-License-Identifier: BSD-3-Clause
// Model edges: patch borders and the creases that are design, not noise.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

struct FeatureOptions {
  enum { automatic, angles, none } mode = automatic;
  double strong = 40, weak = 20;  ///< degrees; a chain starts at strong edges and goes on along weak ones (hysteresis)
  double size = 0;                ///< target edge length h; 0: the mean edge length
};

struct FeatureReport {
  int model_edges = 0, patch_edges = 0, crease_edges = 0, corners = 0;
};

/// Sets face column `model`: bit i of triangle t is set if the edge from corner i to i+1 is a model edge (set on both sides).
/// Borders between patches (face column `patch`) are always model edges; the mesh border needs no bit.
/// automatic: crease chains that are closed or run from corner to corner, are longer than 5 h and turn smoothly.
FeatureReport mark_features(Surface& surface, const FeatureOptions& options);

}  // namespace meshpipe
