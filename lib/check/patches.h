// SPDX-License-Identifier: BSD-3-Clause
// Labels and orientation of a result, compared with those of the reference.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// All triangles with patches of one name; lengths and areas in the units of the surface.
struct Patch {
  std::string name;
  std::vector<int> labels;  ///< that have it, ascending
  double area = 0;
  double perimeter = 0;  ///< 0 unless neighbors are known
  double edge = 0;       ///< the longest
  Box box{};
  int triangles = 0;
};

/// Measures the patches of a surface, sorted by name; none without face column `patch`. `opposite` may be
/// empty. `name(label)` returns the name of a label.
std::vector<Patch> patches_of(const Surface& surface, const std::vector<int>& opposite,
                              const std::function<std::string(int)>& name);

/// A patch that the result lacks or gives another extent.
struct PatchFault {
  std::string fact;
  std::vector<int> labels{};  ///< of the result
};

/// Returns the patches that only one of both has, and those whose extent is another: a bounding box off by
/// more than the patch's longest edge in the result, or an area off by more than half of the reference's plus
/// half that edge times the perimeter. Requires: both sorted by name.
std::vector<PatchFault> compare_patches(const std::vector<Patch>& reference,
                                        const std::vector<Patch>& result);

/// Returns the smaller half-edge of each edge between patches (per triangle) that is no model edge.
std::vector<int> unmarked_borders(const Connectivity& surface, const std::vector<int>& patch);

/// Returns the first triangle of each component oriented against the nearest part of the reference: by the
/// vote of evenly spread triangles, weighted by area. `tree`: of the reference; null: one is made, of what is
/// near.
std::vector<int> reversed_components(const Connectivity& result, const Mesh& reference, const Bvh* tree);

/// Leaves out of reversed_components those that face as the reference's triangles of their patches do, by the
/// sums of area vectors, or by volumes where these vanish; not where another component has one of the
/// patches. `labeled`: the result with face column `patch`, which the reference has as well, if any.
void leave_out_as_labeled(std::vector<int>& reversed, const Connectivity& result, const Surface& labeled,
                          const Surface& reference);

}  // namespace meshpipe
