// SPDX-License-Identifier: BSD-3-Clause
// The multiscale Laplace partitioner of the paper's section 3: cuts a part of genus 0 and large aspect ratio in two.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

struct MultiscaleOptions {
  double max_aspect = 4;      ///< eta_max of eq. (5)
  double min_area = 1e-10;    ///< A_min, relative to the level's disk
  int min_set = 10;           ///< smaller sets of small triangles stay good (the paper's footnote)
  int directions = 16;        ///< root directions tried
};

/// Cuts every part (face column `part`) whose geodesic aspect ratio exceeds max_aspect, recursively, and renumbers
/// parts 0..n-1. Each result is edge-connected, vertex-manifold, touches itself nowhere, has genus 0, N_B >= 1.
/// Triangles are split along the cut (lib/cut.h). Precondition: parts of genus 0 with a boundary.
/// Throws GoalMissed if a part cannot be cut. Returns the number of parts.
int multiscale_cut(Surface& surface, const MultiscaleOptions& options = {});

}  // namespace meshpipe
