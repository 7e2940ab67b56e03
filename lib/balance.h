// SPDX-License-Identifier: BSD-3-Clause
// Moves a cut so that it halves every branch of a part along opposite sides, and is smooth.
#pragma once
#include <vector>

#include "lib/levels.h"

namespace meshpipe {

/// May the vertex change sides without changing the topology of either side of the field's zero level?
/// `corner` is a half-edge that leaves it.
bool is_simple(const std::vector<Tri>& tris, const std::vector<int>& opposite,
               const std::vector<double>& field, int corner);

/// The branches of a part as its Laplace maps see them: the map of a tube of radius r is exp((-z + i s) / r)
/// around the centre of the set or hole behind it.
/// Rings of like distance to the centre are therefore sections of the tube.
struct Branches {
  std::vector<double>
      radius;             ///< of vertices: the distance to the nearest such centre over the map's stretch
  std::vector<int> ring;  ///< of vertices: of the two rings that it lies between, the first
  std::vector<double> between;  ///< of vertices: 0 on that ring, 1 on the next, ring + 1
  int rings = 0;
};
Branches find_branches(const FilledDisk& disk, const std::vector<Level>& levels);

/// Leads a strip one vertex wide, along a shortest path over edges, from the other side to every hole that
/// lies in one side as a whole; only where that cuts the side open and does no more. balance_sides widens it.
void reach_holes(const FilledDisk& disk, const std::vector<int>& opposite, std::vector<double>& field);

/// Threshold dynamics of the sides of the zero level at the scale of the branches: new sides are the signs of
/// S^2 (1 - P) s, where S smooths over the radius and P takes the mean over the ring. On a tube that
/// leaves mostly the first harmonic around it: two halves on opposite sides. Vertices change sides one after
/// another and only where that keeps the topology of both sides; so a strip that is too thin grows, and the
/// ends of the cut slide along the borders. Half-edges with crease[h] != 0 (empty: none) conduct little from
/// one of their sides to the other, so that the cut stays where it meets them.
void balance_sides(const FilledDisk& disk, const std::vector<int>& opposite, const Branches& branches,
                   const std::vector<char>& crease, std::vector<double>& field, int rounds);

}  // namespace meshpipe
