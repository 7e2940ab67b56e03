// SPDX-License-Identifier: BSD-3-Clause
// Components of plane faces; for lib/feature/ only.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Where the parts of a surface bend.
struct Bends {
  const std::vector<double>& angle;   ///< per half-edge, between the triangles on either side
  const std::vector<char>& strong;    ///< per half-edge: is it a crease by its angle?
  const std::vector<int>& component;  ///< per triangle
  int components;
};

/// Flags the components that consist of plane faces of several triangles, as extruded and machined parts do,
/// unless most creases, by length, are steps: next to a face that goes up to one and down to another face,
/// both with almost the same normal, as the steps of segmented images do.
std::vector<char> made_of_planes(const Connectivity& surface, const Bends& bends);

}  // namespace meshpipe
