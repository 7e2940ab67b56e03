// SPDX-License-Identifier: BSD-3-Clause
// Plane faces of components; for lib/feature/ only.
#pragma once
#include <numbers>
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// The angle across diagonals of plane faces, at most, with rounded coordinates.
constexpr double flat_angle = std::numbers::pi / 180;

/// Where the components of a surface bend.
struct Bends {
  const std::vector<double>& angle;   ///< per half-edge, between the triangles on either side
  const std::vector<char>& strong;    ///< per half-edge: is it a crease by its angle?
  const std::vector<int>& component;  ///< per triangle
  int components;
};

/// Shares of a component: of its area in plane faces of several triangles, and of 8 or more; of creases.
struct PlaneShares {
  double several = 0, many = 0, steps = 0;
};

/// Returns the shares of each component (NaN without area or creases). A step is a crease next to a face that
/// goes up to one and down to another face, with almost equal normals, as in segmented images.
std::vector<PlaneShares> plane_shares(const Connectivity& surface, const Bends& bends);

}  // namespace meshpipe
