// SPDX-License-Identifier: BSD-3-Clause
// Conformal maps with a free border: boundary first flattening, least squares, and the spectral form.
#pragma once
#include "lib/param/disk.h"

namespace meshpipe {

/// Boundary first flattening (Sawhney and Crane 2017): the border keeps its length, so that the area scale
/// varies as little as a conformal map allows, and limbs do not shrink exponentially as with held vertices.
/// At most two real factorizations: bent borders need one of their own.
class BoundaryFirst {
 public:
  /// Keeps references to part and disk. `filled`: flat_holes. Throws: GoalMissed if the matrix is singular.
  BoundaryFirst(const SubMesh& part, const Disk& disk, Filled filled);

  /// Returns the largest over the smallest area scale of the map at bend 0 at the part's vertices, without
  /// the extreme 1 % at either end.
  double area_distortion() const { return area_distortion_; }

  /// Returns the image of the longest loop: with the turns of the conformal map that keeps its lengths (bend
  /// 0), or with turns interpolated by `bend` to those of a circle (bend 1) and the lengths that a conformal
  /// map then has. Empty if it does not close.
  std::vector<Vec2> polygon(double bend);

  /// Returns the map with this image of the longest loop, harmonic inside, scaled to the part's area.
  std::vector<Vec2> map(const std::vector<Vec2>& polygon) const;

 private:
  std::vector<double> extend(const std::vector<double>& charge, const std::vector<double>& held,
                             int columns) const;

  const SubMesh& part_;
  const Disk& disk_;
  Filled filled_;  ///< without its shapes: the weights stand for them
  int n_ = 0;
  std::vector<double> weights_, angle_sum_;
  std::vector<int> unknown_;
  Factorization<double> factorization_;
  double area_distortion_;
  std::vector<double> turn_;   ///< at bend 0
  std::vector<double> scale_;  ///< of the lengths, log, at bend 1; empty until asked for
};

/// Computes the least squares conformal map (Levy and others 2002, Desbrun and others 2002): minimizes the
/// Dirichlet energy less the area, with two distant border vertices held; the longest loop, and holes that
/// are left open, get the natural condition. Returns a point per vertex, scaled to the part's area. Throws:
/// GoalMissed if the matrix is singular.
std::vector<Vec2> least_squares_map(const SubMesh& part, const Disk& disk, const Filled& filled);

/// Computes the map that minimizes the same energy among those whose border has unit moment around its
/// center, by inverse iteration: no vertex is held (Mullen and others 2008). Throws: GoalMissed if it fails.
std::vector<Vec2> spectral_map(const SubMesh& part, const Disk& disk, const Filled& filled);

}  // namespace meshpipe
