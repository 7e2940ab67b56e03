// SPDX-License-Identifier: BSD-3-Clause
// Moves a cut so that it halves every branch of a part along opposite sides, and is smooth.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"
#include "lib/multiscale/levels.h"

namespace meshpipe {

/// Returns whether the vertex may change sides without changing the topology of either side of the field's
/// zero level. `corner` is a half-edge that leaves it.
bool is_simple(const Connectivity& part, const std::vector<double>& field, int corner);

/// The branches of a part as its Laplace maps see them: the map of a tube of radius r is exp((-z + i s) / r)
/// around the center of the set or hole behind it. So rings of like distance to it are sections of the tube.
struct Branches {
  /// Of vertices: the distance to the nearest such center over the map's stretch.
  std::vector<double> radius;
  std::vector<int> ring;        ///< of vertices: of the two rings that it lies between, the first
  std::vector<double> between;  ///< of vertices: 0 on that ring, 1 on the next, ring + 1
  int rings = 0;
};
Branches find_branches(const FilledDisk& disk, const std::vector<Level>& levels);

/// Leads a strip one vertex wide, along a shortest path over edges, from the other side to every hole that
/// lies in one side as a whole; only where that cuts the side open and does no more. balance_sides widens it.
void reach_holes(const FilledDisk& disk, const Connectivity& part, std::vector<double>& field);

/// Balances the sides of the zero level by threshold dynamics at the scale of the branches: new sides are the
/// signs of S^2 (1 - P) s, where S smooths over the radius and P takes the mean over the ring. On a tube that
/// leaves mostly the first harmonic around it: two halves on opposite sides. Vertices change sides one by
/// one, only where that keeps the topology of both, so that thin strips grow, and ends of the cut slide along
/// borders.
void balance_sides(const FilledDisk& disk, const Connectivity& part, const Branches& branches,
                   std::vector<double>& field, int rounds);

}  // namespace meshpipe
