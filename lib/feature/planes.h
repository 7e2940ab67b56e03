// SPDX-License-Identifier: BSD-3-Clause
// Plane faces of components; for lib/feature/ only.
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

/// Of the area, in plane faces of several triangles, and of eight or more; and of the creases' length.
struct PlaneShares {
  double several = 0, many = 0, steps = 0;
};

/// Returns the shares in each component (NaN without area or creases). A step is next to a face that goes up
/// to one and down to another face, both with almost the same normal, as on surfaces of segmented images.
std::vector<PlaneShares> plane_shares(const Connectivity& surface, const Bends& bends);

}  // namespace meshpipe
