// SPDX-License-Identifier: BSD-3-Clause
// Slivers of regions that a cut leaves beside model edges.
#pragma once
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// Hands regions (bounded by model edges, the border and other parts) that are thinner than 0.4 of the
/// input's triangles there to the part on the other side of the cut that made them, so that the cut follows
/// the model edges instead. Only face column `part` (0..n-1; triangles of -1 are left alone) changes; the
/// surface has face columns `origin` and, if it has model edges, `model`. Parts that map to the plane stay
/// so, and below max_faces triangles (0: any number); what would break that stays. Returns true if a triangle
/// has changed hands. n log n; at once where there are no model edges.
bool hand_over_slivers(Surface& surface, const std::vector<int>& opposite, int n_parts, int max_faces = 0);

}  // namespace meshpipe
