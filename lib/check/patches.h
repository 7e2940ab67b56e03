// SPDX-License-Identifier: BSD-3-Clause
// Labels and orientation of a result, compared with those of the reference.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// A patch as its user knows it: all triangles of one name.
struct Patch {
  std::string name;
  double area = 0;
  double perimeter = 0;  ///< 0 unless neighbors are known
  double edge = 0;       ///< the longest
  Box box{};
  int triangles = 0;
};

/// Measures the patches of a surface, sorted by name; none without face column `patch`. `opposite` may be
/// empty. `name` gives that of a label.
std::vector<Patch> patches_of(const Surface& surface, const std::vector<int>& opposite,
                              const std::function<std::string(int)>& name);

/// Says which patches of the reference are lost in the result, and which have another extent: a bounding box
/// off by more than their longest edge, or an area by more than half of it and half that edge along the
/// border.
std::vector<std::string> compare_patches(const std::vector<Patch>& reference,
                                         const std::vector<Patch>& result);

/// Returns the half-edges, one per edge, between two patches that are not model edges.
std::vector<int> unmarked_borders(const Connectivity& surface, const std::vector<int>& patch);

/// Returns a triangle of each component that is inconsistently oriented with the nearest part of the
/// reference, by the vote of evenly spread triangles and their areas. `tree`: of the reference; null: one of
/// what is around these triangles is enough.
std::vector<int> reversed_components(const Connectivity& result, const Mesh& reference, const Bvh* tree);

}  // namespace meshpipe
