// SPDX-License-Identifier: BSD-3-Clause
// Smoothing of segmentations within a bound: the stairs of voxels and marching cubes.
#pragma once
#include <string>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

struct SmoothOptions {
  double within = 0;           ///< no vertex is farther than this from where it was; 0: `default_bound`
  bool keep_features = false;  ///< vertices of model edges (face column `model`) stay
};

struct SmoothReport {
  double within = 0;                         ///< the bound
  double farthest = 0;                       ///< that a vertex was moved
  Vec3 farthest_at{};                        ///< where that vertex was
  double volume = 0, volume_change = 0;      ///< enclosed, ends closed by flat caps; after less before
  double angle_before = 0, angle_after = 0;  ///< root mean square between adjacent triangles, degrees
  int bounded = 0;                           ///< vertices that the bound holds back
  int moved_back = 0;                        ///< vertices moved back where triangles would intersect
  int planar_ends = 0, kept_ends = 0;        ///< border loops that slide along a plane, or stay
  double region_change = 0;                  ///< of sheets: the largest change of a region's volume, relative
};

/// Smooths the surface; its volume stays within 0.1 %. Vertices of border loops within a tenth of their
/// radius from a plane move along it; others, and what `keep_features` names, stay where they are; no two
/// triangles newly intersect.
/// Throws: NotAdmissible if there are no triangles, or they are no oriented manifold; GoalMissed with the
/// number expected if `within` is too small to smooth anything, or to keep the volume.
/// Source: Taubin, A signal processing approach to fair surface design, 1995, with the normal displacement,
/// averaged, in place of his negative steps.
SmoothReport smooth(Surface& surface, const SmoothOptions& options);

/// Flips the third edge of triangles that have two on a line where sheets meet, unless they have a model
/// edge, another patch is beyond, or the two triangles are not flat: smoothing would fold them over their
/// neighbors as it straightens the line.
void flip_ears(Surface& surface);

/// Smooths sheets that meet, whose border vertices with the same coordinates are one. Lines where they meet
/// are smoothed as lines; free borders stay. Volumes are kept, region by region, as far as the bound permits.
/// Throws: NotAdmissible if there are no triangles. Source: Taubin as above, with his negative steps.
SmoothReport smooth_sheets(Surface& surface, const SmoothOptions& options);

/// Returns the report as sentences, one per line of output.
std::vector<std::string> describe(const SmoothReport& report);

}  // namespace meshpipe
