// SPDX-License-Identifier: BSD-3-Clause
// One-to-one maps of every part to the plane (the paper's section 2): conformal, harmonic, convex
// combination, each proved valid, with repair and fallback.
#pragma once
#include "lib/chart.h"
#include "lib/mesh.h"
#include "lib/param_circle.h"
#include "lib/param_disk.h"

namespace meshpipe {

enum class MapKind { conformal = 0, harmonic = 1, convex = 2 };

/// How the conformal map is found (lib/param_conformal.h).
enum class ConformalForm { boundary_first = 0, least_squares = 1, spectral = 2 };

struct ParamOptions {
  MapKind map = MapKind::conformal;
  ConformalForm form = ConformalForm::boundary_first;
  Weights weights = Weights::cotangent;  ///< of the convex map
  /// The paper's natural condition on all loops but the longest, instead of holes filled in the solve: of the
  /// map asked for, not of those that take its place.
  /// BadUsage with boundary_first, which has to know how much each hole turns.
  bool neumann = false;
  int optimize = 0;     ///< steps of lower_distortion (lib/param_optimize.h) at the end
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
  int steps = 0;                  ///< of optimisation
  /// Pairs of the part's vertices that should not be in one chart: a few places where the border of the map
  /// asked for crossed itself, else the triangles of the least and of the largest area scale.
  std::vector<std::array<int, 2>> apart;
  double anisotropy_median = 1, anisotropy_p99 = 1, anisotropy_max = 1;  ///< sigma1 / sigma2 of the map
  double anisotropy_mean = 1;  ///< over the area: what the mesher makes too many triangles by
  double area_scale = 1;       ///< p99 / p1 of the area scale
  double smallest_area = 0;    ///< in the plane, over the chart's area
  SolveTime time;              ///< of all that was tried
};

/// Distortion of a map: the report's anisotropies, area_scale, smallest_area, and `apart` if that is empty.
/// Triangles without area in space are left out.
void measure_distortion(const SubMesh& part, const std::vector<Vec2>& uv, ParamReport& report);

/// The map asked for, without proof or repair; scaled to the part's area. Throws NotAdmissible if the part is
/// not a disk with holes, GoalMissed if the equations are singular or a border does not close.
std::vector<Vec2> plain_map(const SubMesh& part, const ParamOptions& options);

/// Maps a part: as asked for, else repaired (single vertices moved into the kernel of their star, patches
/// around inverted triangles solved again with positive weights, then the inside as a whole), else the next
/// of conformal, conformal with a border bent towards a circle until it does not cross itself, harmonic,
/// convex; after a circle map that was asked for, the conformal ones are the last resort. The distortion of
/// any other map than the one asked for, and of a conformal one, is lowered if sigma1/sigma2 is above 4 for
/// more than 1 % of the triangles, or above 1.5 in the mean over the area, up to 20000 triangles. With
/// `strict` there is only the map asked for. The result is proved one-to-one (exact orientation of every
/// triangle, simple borders). Throws GoalMissed if no map is; never returns a bad one. Returns none, early,
/// with area_scale set, if that of a map by boundary first flattening would be above `most_uneven`.
std::vector<Vec2> map_part(const SubMesh& part, const ParamOptions& options, ParamReport& report,
                           double most_uneven = HUGE_VAL);

/// Maps every part of the surface (face column `part`, 0..n_parts-1), charts in parallel. A part is cut, and
/// its pieces are mapped in its place, if it has no one-to-one map; if its area scale varies by more than 1e8
/// (p99 / p1), since a limb that shrinks that much does so by a factor over every few elements, and loses its
/// shape; or if sigma1/sigma2 is above 4 in the mean over its area: the coarse tubes and rings of CAD, with
/// nothing between their ends to follow a ring in the plane, have such maps, and lie flat once they are open
/// (but a circle map that was asked for and is one-to-one may be so). The cut is along the model edges inside
/// the part, where these bound simple pieces: it costs the mesh nothing there, and is made above 4 (p99) too;
/// else along its limbs; else by a short line between the places that should not be in one chart
/// (lib/bisect.h). A limb with N edges round that is mapped to a ring changes its scale by exp(2 pi / N) over
/// each of them, which shears its triangles to about 1 + 3.6 / N: where the median is above 1.05 and the
/// geodesic aspect ratio above 2, a part of 500 triangles or more without model edges is cut along its limbs
/// if that is much better in all pieces; in the first two rounds, and not where a circle map was asked for.
/// Ears of parts that go to a circle, triangles with two edges on the longest loop, are split through their
/// third edge, since a circle flattens them. Both append vertices and split triangles, and
/// rewrite face column `part`; with `strict` there is neither. reports has one entry a part.
std::vector<Chart> map_surface(Surface& surface, int n_parts, const ParamOptions& options,
                               std::vector<ParamReport>& reports);

}  // namespace meshpipe
