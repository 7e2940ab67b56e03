// SPDX-License-Identifier: BSD-3-Clause
// The table of a surface's parts.
#pragma once
#include "lib/core/topology.h"

namespace meshpipe {

/// The stream's table `part`, one row per part: int genus loops faces; double area eta_cyl eta_box eta_geo.
Table part_table(const std::vector<Topology>& parts);
/// The table of the parts that face column `part` names, 0..n-1. Rows of `known`, if given, stay for parts
/// that still have their number of faces and their area.
Table part_table(const Surface& surface, int n, const Table* known = nullptr);
/// Returns those rows; of no triangles for other parts.
std::vector<Topology> known_parts(const Surface& surface, int n, const Table* known);

}  // namespace meshpipe
