// SPDX-License-Identifier: BSD-3-Clause
// Splitting edges of a surface, and of its charts, in their middle.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Splits the edges whose half-edges are marked (both, where there are two) in their middle and triangles
/// accordingly; the surface as a set of points stays. New vertices are appended; vertex columns of doubles
/// are interpolated, of others copied from the end of the smaller number; face columns are copied, `model`
/// bits are split with their edges. `chart` is the stream's table chart_vertex, or null: the maps stay linear
/// on the earlier triangles, and no triangle is split that would lose its orientation in the plane by
/// rounding. `opposite` belongs to the surface as it comes. Returns, per triangle of the result, the one it
/// is part of; that is empty if nothing was split.
std::vector<int> split_edges(const CutSurface& s, std::vector<char> mark, Table* chart);

}  // namespace meshpipe
