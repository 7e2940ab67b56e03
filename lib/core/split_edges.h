// SPDX-License-Identifier: BSD-3-Clause
// Splitting edges of a surface, and of its charts, in their middle.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Splits the edges whose half-edges are marked (mark[h] != 0, on one side or both) in their middle, and
/// their triangles accordingly; the set of points is the same. New vertices are appended, their doubles
/// interpolated, other columns copied from the end with the smaller number; face columns are copied, `model`
/// bits split with their edges. `chart`: table chart_vertex, which gets rows for the new vertices, or null;
/// with it, no triangle is split that would lose its orientation in the plane by rounding. Opposite
/// half-edges are read, and do not follow. Returns per triangle the one it is part of; empty: none was split.
std::vector<int> split_edges(const CutSurface& s, std::vector<char> mark, Table* chart);

}  // namespace meshpipe
