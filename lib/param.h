// SPDX-License-Identifier: BSD-3-Clause
// One-to-one maps of a part to the plane (the paper's section 2): conformal, and convex combination as the
// guarantee.
#pragma once
#include "lib/chart.h"
#include "lib/mesh.h"

namespace meshpipe {

enum class MapKind { conformal = 0, harmonic = 1, convex = 2 };

struct ParamReport {
  MapKind used = MapKind::conformal;
  int flips_before = 0;           ///< inverted or zero-area triangles of the map asked for
  bool border_was_simple = true;  ///< of that map
  /// Pairs of the part's vertices that should not be in one chart: a few places where the border of that map
  /// crossed itself, else the triangles of the least and of the largest area scale.
  std::vector<std::array<int, 2>> apart;
  double anisotropy_median = 1, anisotropy_p99 = 1, anisotropy_max = 1;  ///< sigma1 / sigma2 of the map
  double area_scale = 1;                                                 ///< p99 / p1 of the area scale
  double smallest_area = 0;  ///< in the plane, over the chart's area
};

/// Conformal map with a free border by boundary first flattening (Sawhney and Crane 2017): the border keeps
/// its length, so that the area scale varies as little as a conformal map allows, and limbs do not shrink
/// exponentially as in least squares conformal maps with pins. One real factorisation, three solves. Loops
/// other than the longest are filled by a fan of triangles around a virtual centre as for a round hole of the
/// same perimeter. uv is scaled so that the plane area equals the area in space.
/// Throws NotAdmissible if the part is not a disk with holes, GoalMissed if the border does not close.
/// May be invalid: check with lib/injective.h.
std::vector<Vec2> conformal_map(const SubMesh& part);

/// Convex combination map onto the unit disk (then scaled to the part's area): arc length on the longest
/// loop, other loops filled by a virtual centre, clamped cotangent weights. One-to-one up to rounding (Tutte,
/// Floater). Throws like conformal_map.
std::vector<Vec2> convex_map(const SubMesh& part);

/// Distortion of a map: the report's last five numbers. Triangles without area in space are left out.
void measure_distortion(const SubMesh& part, const std::vector<Vec2>& uv, ParamReport& report);

/// Maps a part: the kind asked for, else repaired locally, else the next of conformal -> convex (neither with
/// `strict`). The result is proved one-to-one (exact orientation of every triangle, simple border). Throws
/// GoalMissed if no map is; never returns a bad one.
std::vector<Vec2> map_part(const SubMesh& part, MapKind kind, bool strict, ParamReport& report);

/// Maps every part of the surface (face column `part`, 0..n_parts-1), charts in parallel. A part is cut in
/// two and its halves are mapped in its place,
///  - by a short line between the places that should not be in one chart, if it has no valid map;
///  - by such a line, if the conformal map is not valid and the convex one in its place has sigma1/sigma2
///  above 4 in
///    more than one triangle of a hundred: limbs of a tree that cross in the plane are the usual reason, a
///    circle map of them has a median of 5 to 10, and the cut is one more of the lines that mrelax frees;
///  - along its limbs, if the area scale varies by more than 1e6 (p99 / p1), as it does along a narrow tube
///  (lib/bisect.h).
/// Such cuts append vertices and rewrite face column `part`; with `strict` there are none.
/// reports has one entry a part.
std::vector<Chart> map_surface(Surface& surface, int n_parts, MapKind kind, bool strict,
                               std::vector<ParamReport>& reports);

}  // namespace meshpipe
