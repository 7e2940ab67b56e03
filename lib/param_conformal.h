// SPDX-License-Identifier: BSD-3-Clause
// Conformal maps with a free border: boundary first flattening, least squares, and the spectral form.
#pragma once
#include "lib/param_disk.h"

namespace meshpipe {

/// Boundary first flattening (Sawhney and Crane 2017): the border keeps its length, so that the area scale
/// varies as little as a conformal map allows, and limbs do not shrink exponentially as with pins. Two real
/// factorisations at most: bent borders need one of their own.
class BoundaryFirst {
 public:
  /// Keeps references to the part and the disk. `filled`: flat_holes of the part. Throws GoalMissed if the
  /// matrix is singular.
  BoundaryFirst(const SubMesh& part, const Disk& disk, Filled filled, SolveTime* time);

  /// Largest over smallest area scale that the map at bend 0 will have at the part's vertices, 1 % of them
  /// left out at either end.
  double unevenness() const { return unevenness_; }

  /// The longest loop's polygon, in its order: with the turns of the conformal map that keeps its lengths
  /// (bend 0), or with turns that are `bend` of the way to those of a circle, and the lengths that a
  /// conformal map then has. 1: a convex polygon, the border of a conformal map to a round disk. Empty if it
  /// does not close.
  std::vector<Vec2> polygon(double bend);

  /// The map of all vertices inside such a polygon, harmonic in it; scaled to the part's area.
  std::vector<Vec2> map(const std::vector<Vec2>& polygon) const;

 private:
  std::vector<double> extend(const std::vector<double>& charge, const std::vector<double>& held,
                             int columns) const;

  const SubMesh& part_;
  const Disk& disk_;
  Filled filled_;  ///< without its shapes: the weights stand for them
  SolveTime* time_;
  int n_ = 0;
  std::vector<double> weights_, angle_sum_;
  std::vector<int> unknown_;
  Factorisation<double> factorisation_;
  double unevenness_;
  std::vector<double> turn_;   ///< at bend 0
  std::vector<double> scale_;  ///< of the lengths, log, at bend 1; empty until asked for
};

/// Least squares conformal map (Levy and others 2002, Desbrun and others 2002): Dirichlet energy less the
/// area, as one Hermitian matrix for u + i v; of the border two vertices far apart are held. The natural
/// condition holds on the longest loop, and on holes that are not filled. Scaled to the part's area.
std::vector<Vec2> least_squares_map(const SubMesh& part, const Disk& disk, const Filled& filled,
                                    SolveTime* time);

/// The same energy least among maps whose border has unit moment around its centre (Mullen and others 2008):
/// no vertex is held. By inverse iteration. Throws GoalMissed if that does not converge.
std::vector<Vec2> spectral_map(const SubMesh& part, const Disk& disk, const Filled& filled, SolveTime* time);

}  // namespace meshpipe
