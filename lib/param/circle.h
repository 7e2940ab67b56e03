// SPDX-License-Identifier: BSD-3-Clause
// Maps onto the unit disk: harmonic (the paper's eq. 3) and convex combination.
#pragma once
#include "lib/param/disk.h"

namespace meshpipe {

/// Weights of a map's equations sum_j w_ij (u_i - u_j) = 0.
enum class Weights {
  finite_element,  ///< cotangents: harmonic; not one-to-one where obtuse angles make them negative
  cotangent,       ///< cotangents kept between 0.01 and 100
  mean_value,      ///< (tan(alpha / 2) + tan(beta / 2)) / length (Floater 2003); not symmetric
  uniform          ///< 1 (Tutte 1963)
};

/// Returns (u, v) per vertex of the part: on the unit circle by arc length for the longest loop, 0 for
/// others. No edge gets less than a hundredth of the mean edge's share, so that its arc is not straight to
/// rounding: a triangle with two border edges would become flat.
std::vector<Vec2> circle_border(const SubMesh& part, const Disk& disk);

/// Solves for the vertices off the longest loop, whose places (in `border`, per vertex) are held; returns a
/// point per vertex of the part. With positive weights, a convex polygon and filled holes the result is
/// one-to-one except for rounding (Tutte, Floater). Throws: GoalMissed if the matrix is singular.
std::vector<Vec2> extend_border(const SubMesh& part, const Filled& filled, const Disk& disk, Weights weights,
                                std::vector<Vec2> border);

}  // namespace meshpipe
