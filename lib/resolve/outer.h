// SPDX-License-Identifier: BSD-3-Clause
// The regions that pieces of an arrangement divide space into, and the boundary of the outside.
#pragma once
#include <vector>

#include "lib/resolve/arrange.h"

namespace meshpipe {

/// What becomes of the pieces of an arrangement.
struct Hull {
  std::vector<signed char> keep;  ///< 1 as it is, -1 reversed, 0 not at all
  std::vector<int> component;     ///< per piece: of pieces that meet along edges
  std::vector<char> open;         ///< per component: it has borders, or winds inconsistently
  std::vector<char> ambiguous;    ///< per component: what is outside is not determined, all is kept
  int subtracted = 0;             ///< bodies of the input that are inside out where they overlap others
};

/// Finds the boundary between regions of positive winding number and others, oriented away from the former.
/// Open components have the outside in front, as far as that determines where they pass through each other;
/// where it does not, and most of a component encloses regions, these are solid: what is not on their outside
/// goes. Weights (`weight`: per triangle of `tris`, the input) change sign in closed components that are
/// inside out. Returns one row per piece.
/// Source: Zhou, Grinspun, Zorin and Jacobson, Mesh Arrangements for Solid Geometry, 2016, for closed
/// components.
Hull outer_hull(Pieces& pieces, const std::vector<Tri>& tris, const std::vector<int>& weight,
                const ExactPoints& points);

}  // namespace meshpipe
