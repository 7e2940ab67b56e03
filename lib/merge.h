// SPDX-License-Identifier: BSD-3-Clause
// Merging patches, so that they are remeshed across their common borders (the paper's cross-patch
// parametrization, section 5.3).
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

/// Which patch each patch becomes part of: `patch` ascending, `into` by the same index. A patch that stays is
/// its own.
struct PatchMerge {
  std::vector<int> patch, into;
  int operator()(int label) const;
  int count() const;  ///< patches that are left
};

/// Every patch for itself. Column `patch` of the faces is read; a surface without one has the patch 1.
PatchMerge no_merge(const Surface& surface);

/// Makes the patches of each group one, which has the label of the first. Groups that share a patch are one.
/// Throws NotAdmissible naming a label that no face has.
void merge_groups(PatchMerge& merge, const std::vector<std::vector<int>>& groups);

/// Merges patches that are tangent, the normals on both sides of their common border differing by at most
/// `angle` radians over 95 % of its length; then, smallest first, patches that are smaller than the mesh size
/// h (twice the area over the perimeter, which is half a square's side and a strip's width, is below h / 2)
/// into the neighbour to which they turn least, if that is by at most 60 degrees. A merged patch has the
/// label of its largest member.
void merge_automatically(PatchMerge& merge, const Surface& surface, double h, double angle);

}  // namespace meshpipe
