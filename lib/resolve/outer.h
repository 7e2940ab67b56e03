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
};

/// Finds the boundary between regions of winding number 0 and others, oriented away from the others. All
/// pieces of open components are kept, and do not count for the winding number of others.
/// Returns one row per piece. Source: Zhou, Grinspun, Zorin, Jacobson 2016, in exact arithmetic.
Hull outer_hull(const Pieces& pieces, const std::vector<Tri>& tris, const std::vector<int>& weight,
                const ExactPoints& points);

}  // namespace meshpipe
