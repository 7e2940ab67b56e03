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
  int flips_before = 0;         ///< inverted or zero-area triangles of the map asked for
  bool overlap_before = false;  ///< its border crossed itself
  double anisotropy_median = 1, anisotropy_p99 = 1, anisotropy_max = 1;  ///< sigma1 / sigma2 of the map
  double area_scale = 1;                                                 ///< p99 / p1 of the area scale
  double smallest_area = 0;  ///< in the plane, over the chart's area
};

/// Least-squares conformal map with a free border (Levy 2002, Desbrun 2002), one Hermitian factorisation.
/// Loops other than the longest are filled by a fan of triangles around a virtual centre as for a round hole
/// of the same perimeter: with a second free border the inside-out map z -> 1/z would be as conformal as the
/// wanted one. uv is scaled so that the plane area equals the area in space. Throws NotAdmissible if the part
/// is not a disk with holes. May be invalid: check with lib/injective.h.
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
/// two (lib/cut.h) across its long direction, where a cut is short, and its halves are mapped in its place,
/// if it has no valid map, or if the conformal one is not and the convex one that would take its place is too
/// anisotropic to mesh well: sigma1/sigma2 above 20 in more than one triangle of a hundred. Such splits
/// append vertices and rewrite face column `part`; with `strict` there are none. reports has one entry a
/// part.
std::vector<Chart> map_surface(Surface& surface, int n_parts, MapKind kind, bool strict,
                               std::vector<ParamReport>& reports);

}  // namespace meshpipe
