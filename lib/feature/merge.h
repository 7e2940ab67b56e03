// SPDX-License-Identifier: BSD-3-Clause
// Merging patches, so that they are remeshed across their common borders (the paper's cross-patch
// parametrization, section 5.3).
#pragma once
#include "lib/core/mesh.h"

namespace meshpipe {

/// The patch that each patch becomes part of: `patch`, ascending, and `into` with the same index.
struct PatchMerge {
  std::vector<int> patch, into;
  int operator()(int label) const;
  int count() const;  ///< patches that are left
};

/// Returns the merge that leaves every patch of face column `patch` (1 without one) as it is.
PatchMerge no_merge(const Surface& surface);

/// Merges the patches of each group into its first. Groups that share a patch become one.
/// Throws: NotAdmissible naming a label that no face has.
void merge_groups(PatchMerge& merge, const std::vector<std::vector<int>>& groups);

/// Merges patches that are tangent: whose normals differ by at most 20 degrees over 95 % of their border.
/// Then, the smallest first, merges patches with a width (twice the area over the perimeter) below h / 2 into
/// the neighbor whose normal differs least, if by at most 60 degrees. A merged patch has the label of its
/// largest member. h: the target edge length.
void merge_automatically(PatchMerge& merge, const Surface& surface, double h);

}  // namespace meshpipe
