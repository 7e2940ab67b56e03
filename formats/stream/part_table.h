// SPDX-License-Identifier: BSD-3-Clause
// The table of a surface's parts.
#pragma once
#include "lib/core/topology.h"

namespace meshpipe {

/// Returns the stream's table `part`, one row per part: int genus loops faces; double area eta_cyl eta_box
/// eta_geo.
Table part_table(const std::vector<Topology>& parts);
/// Measures the parts 0..n-1 that face column `part` names, and returns their table. Rows of `known`, if
/// given, are used for parts that still have their number of faces and their area.
Table part_table(const Surface& surface, int n, const Table* known = nullptr);
/// Returns the rows of `known` for parts that still have their number of faces and their area; a row without
/// triangles for others.
std::vector<Topology> known_parts(const Surface& surface, int n, const Table* known);

}  // namespace meshpipe
