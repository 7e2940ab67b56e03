// SPDX-License-Identifier: BSD-3-Clause
// Volumes of the regions between sheets; for lib/relax/ only.
#pragma once
#include "lib/relax/relax.h"

namespace meshpipe {

/// Moves vertices inside of sheets, by at most 0.08 of their shortest edge, to bring the volumes of regions
/// near to those of the reference. Leaves all where they are if triangles still intersect after four tries.
/// Returns the largest relative difference of a volume that is left.
double keep_volumes(LiftedMesh& mesh, const Surface& reference, const std::vector<SheetPatch>& sheets);

}  // namespace meshpipe
