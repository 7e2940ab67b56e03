// SPDX-License-Identifier: BSD-3-Clause
// Parts of a surface and the interfaces between them: what they have to be, how they are found, joined and
// straightened.
#pragma once
#include <numbers>
#include <string>

#include "lib/core/connectivity.h"
#include "lib/partition/labeling.h"
#include "lib/partition/merge.h"
#include "lib/partition/thresholds.h"

namespace meshpipe {

/// Returns what breaks the rule of formats/mply.md on parts (`part`: per triangle), and where; or "".
std::string part_fault(const Connectivity& mesh, const std::vector<int>& part);

/// The bend of an inner edge, in radians, above which it is a crease to cuts, marked by mfeature or not.
constexpr double sharp_edge = 40 * std::numbers::pi / 180;
bool is_crease(const Connectivity& mesh, int h);

/// How long and how straight the interfaces between the parts are.
struct Interfaces {
  double length = 0;  ///< of all, over the diagonal of the surface's bounding box
  /// The 90 % quantile and the largest of the angles between successive interface edges on the surface,
  /// degrees: pi |left - right| / (left + right) by the surface's angles on both sides. Not at junctions,
  /// borders and creases.
  double turning_angle = 0, largest_angle = 0;
  int junctions = 0;  ///< vertices with three or more interface edges
};
/// Measures the interfaces between the parts (`part`: per triangle).
Interfaces measure_interfaces(const Connectivity& mesh, const std::vector<int>& part);

/// Moves the interface of each pair of parts (face column `part`, 0..n_parts-1) to the zero level of a
/// diffused indicator of the two sides (threshold dynamics), pulled straight (lib/core/level_line.h, `snap`
/// as there); where that fails, as on triangles much longer than wide, only pulls it straight. Model edges
/// stay interfaces. An interface stays as it was where the result would be longer, or a part
/// would no longer map to the plane, or be joined or divided near it. Adds the face column `origin`. Other
/// parts are only split along the new interfaces. Requires: parts without fault.
void straighten_interfaces(const CutSurface& cut, int n_parts, double snap, int max_faces = 0);

}  // namespace meshpipe
