// SPDX-License-Identifier: BSD-3-Clause
// Cuts through the handles of a surface: short loops that leave it in one piece.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Finds one loop of edges per handle of the connected surface, disjoint, such that it stays connected when
/// cut along all of them (it is a sphere with holes then). Each is the shortest found among the tree-cotree
/// loops of several roots (Erickson and Whittlesey 2005). Returns each loop as half-edges in order; fewer
/// loops than `genus` if the mesh is too coarse for disjoint ones.
std::vector<std::vector<int>> handle_loops(const Connectivity& mesh, int genus);

/// Returns per triangle the nearest side of a loop, reached without crossing any: 2 i for the left side of
/// loop i, 2 i + 1 for its right side. No label lies on both sides of a loop.
std::vector<int> label_by_sides(const Connectivity& mesh, const std::vector<std::vector<int>>& loops);

}  // namespace meshpipe
