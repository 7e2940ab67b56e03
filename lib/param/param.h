// SPDX-License-Identifier: BSD-3-Clause
// One-to-one maps of every part to the plane (the paper's section 2): conformal, harmonic, convex
// combination, each proved valid, with repair and fallback.
#pragma once
#include "lib/core/mesh.h"
#include "lib/param/circle.h"
#include "lib/param/disk.h"
#include "lib/param/ears.h"
#include "lib/param/injective.h"

namespace meshpipe {

enum class MapKind { conformal = 0, harmonic = 1, convex = 2 };

/// How the conformal map is found (lib/param/conformal.h).
enum class ConformalForm { boundary_first = 0, least_squares = 1, spectral = 2 };

struct ParamOptions {
  MapKind map = MapKind::conformal;
  ConformalForm form = ConformalForm::boundary_first;
  Weights weights = Weights::cotangent;  ///< of the convex map
  /// The paper's natural condition on all loops but the longest, instead of holes filled in the solve: of the
  /// map asked for, not of those that take its place.
  /// BadUsage with boundary_first, which has to know how much each hole turns.
  bool neumann = false;
  int optimize = 0;     ///< steps of lower_distortion (lib/param/optimize.h) at the end
  bool strict = false;  ///< no repair, no other map, no cut
};

/// What became of one part. The map used is the one asked for if `used`, and `form` of a conformal one, are.
struct ParamReport {
  MapKind used = MapKind::conformal;
  ConformalForm form = ConformalForm::boundary_first;  ///< of a conformal map that was used
  double bend = 0;                ///< of a conformal map's border towards a circle (BoundaryFirst::polygon)
  int flips_before = 0;           ///< inverted or zero-area triangles of the map asked for
  int flips_after = 0;            ///< of that map after its repair; not 0: another map was taken
  bool border_was_simple = true;  ///< of the map asked for
  int steps = 0;                  ///< of optimization
  /// Pairs of the part's vertices that should not be in one chart: a few places where the border of the map
  /// asked for crossed itself, else the triangles of the least and of the largest area scale.
  std::vector<std::array<int, 2>> apart;
  double anisotropy_median = 1, anisotropy_p99 = 1, anisotropy_max = 1;  ///< sigma1 / sigma2 of the map
  double anisotropy_mean = 1;  ///< over the area: what the mesher makes too many triangles by
  double area_scale = 1;       ///< p99 / p1 of the area scale
  double smallest_area = 0;    ///< in the plane, over the chart's area
};

/// Returns whether the map is a circle map that was asked for: then the user knows that it may be poor.
inline bool is_own_choice(const ParamReport& report, const ParamOptions& options) {
  return report.used == options.map && options.map != MapKind::conformal;
}

/// Sets the distortion of a map in the report: anisotropies, area_scale, smallest_area, and `apart` if that
/// is empty. Triangles without area in space are left out.
void measure_distortion(const SubMesh& part, const std::vector<Vec2>& uv, ParamReport& report);

/// Maps a part one-to-one (exact orientation of every triangle, simple borders): by the map asked for, else
/// its repair, else the next of conformal, conformal with a border bent towards a circle, harmonic, convex
/// (after a circle map that was asked for, the conformal ones); with `strict` only by the map asked for. Maps
/// with a mean of sigma1/sigma2 above 100, except is_own_choice, come last, the one with the least first.
/// Lowers the distortion, up to 20000 triangles, of a conformal map or one not asked for with sigma1/sigma2
/// above 4 on more than 1 % of the triangles, or 1.5 in the mean. Returns none, early, with area_scale set,
/// if that of boundary first flattening would be above `most_uneven`. Throws: GoalMissed if no map is
/// one-to-one; as disk_of.
std::vector<Vec2> map_part(const SubMesh& part, const ParamOptions& options, ParamReport& report,
                           double most_uneven = infinity);

}  // namespace meshpipe
