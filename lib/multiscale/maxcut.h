// SPDX-License-Identifier: BSD-3-Clause
// The area-balancing cut of Alliez, Meyer and Desbrun (Interactive geometry remeshing, 2002) as the paper's
// section 3 recalls it: one map, one straight line. For comparison; it fails where one map has not digits
// enough, as the paper's Figs. 2 and 3 show.
#pragma once
#include <vector>

#include "lib/multiscale/levels.h"

namespace meshpipe {

struct MaxCut {
  Level level;                ///< the one map, of all triangles, on the unit disk
  std::vector<Vec2> line;     ///< from outside the disk to outside
  std::vector<double> field;  ///< a value per vertex of the part, positive on the line's left; never zero
  int too_small = 0;          ///< triangles of the part whose image is smaller than 1e-15
  int reversed = 0;           ///< or has no positive area
};

/// Laplace map (eq. 3) of the whole disk with arc length on its rim; the line passes through the center of
/// gravity of the vertices' images along the principal axis of their second moments J.
/// Throws GoalMissed if the system is singular.
MaxCut max_cut(const FilledDisk& disk);

}  // namespace meshpipe
