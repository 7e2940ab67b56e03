// SPDX-License-Identifier: BSD-3-Clause
// One-to-one maps of a part to the plane (the paper's section 2): conformal, and convex combination as the guarantee.
#pragma once
#include "lib/chart.h"
#include "lib/mesh.h"

namespace meshpipe {

enum class MapKind { conformal = 0, harmonic = 1, convex = 2 };

struct ParamReport {
  MapKind used = MapKind::conformal;
  int flips_before = 0;       ///< inverted or zero-area triangles of the map asked for
  double anisotropy_median = 1, anisotropy_p99 = 1, anisotropy_max = 1;  ///< sigma1 / sigma2 of the map
  double area_scale = 1;      ///< p99 / p1 of the area scale
  double smallest_area = 0;   ///< in the plane, over the chart's area
};

/// Least-squares conformal map with a free border (Levy 2002, Desbrun 2002), one Hermitian factorisation.
/// Other loops than the longest are left free. uv is scaled so that the plane area equals the area in space.
/// Precondition: a disk with holes. May be invalid: check with count_inverted and border_is_simple.
std::vector<Vec2> conformal_map(const SubMesh& part);

/// Convex combination map onto the unit disk (then scaled to the part's area): arc length on the longest loop,
/// other loops filled by a virtual centre, clamped cotangent weights. One-to-one up to rounding (Tutte, Floater).
std::vector<Vec2> convex_map(const SubMesh& part);

/// Number of triangles whose image does not have positive orientation, by the exact predicate.
int count_inverted(const std::vector<Tri>& tris, const std::vector<Vec2>& uv);

/// True if the loops' images are simple polygons that do not touch each other, by exact tests on a grid.
bool border_is_simple(const SubMesh& part, const std::vector<int>& opposite, const std::vector<Vec2>& uv);

/// Maps a part: the kind asked for, else repaired locally, else the next of conformal -> convex. The result is proved
/// one-to-one (exact orientation of every triangle, simple border). Throws GoalMissed if no map is; never returns a bad one.
std::vector<Vec2> map_part(const SubMesh& part, MapKind kind, bool strict, ParamReport& report);

/// Maps every part of the surface, charts in parallel; splits a part that has no valid map (lib/cut.h) and maps the pieces.
/// Sets face column `part` anew where it splits. reports has one entry a part.
std::vector<Chart> map_surface(Surface& surface, MapKind kind, bool strict, std::vector<ParamReport>& reports);

}  // namespace meshpipe
