// SPDX-License-Identifier: BSD-3-Clause
// What the conformal map of a region will look like, foreseen on a coarse model of the surface.
#pragma once
#include <vector>

#include "lib/mesh.h"
#include "lib/vec.h"

namespace meshpipe {

/// Of the conformal map that keeps the length of the region's longest loop (boundary first flattening).
struct Forecast {
  double unevenness = 1;  ///< largest over smallest area scale, 1 % of the area left out at either end
  int crossings = 0;      ///< of the outline with itself, where it is drawn with some hundred corners
};

/// Groups the triangles of a surface into some thousand cells, to solve for the scale of a region's map by
/// finite volumes with two-point fluxes: exact along tubes, within some percent elsewhere, in milliseconds.
class Forecaster {
 public:
  /// Keeps references; `opposite` as opposite_halfedges gives it.
  Forecaster(const Mesh& mesh, const std::vector<int>& opposite);
  /// The map of the union of labels a and b (equal for one region). `border` holds the border half-edges of
  /// the union. Precondition: it maps to the plane (lib/regions.h).
  Forecast of(const std::vector<int>& label, int a, int b, const std::vector<int>& border) const;

 private:
  void grow_cells();
  void spread_curvature();

  const Mesh& mesh_;
  const std::vector<int>& opposite_;
  int n_cells_ = 0;
  std::vector<int> cell_;                 // of each triangle
  std::vector<int> crossing_;             // half-edges from a cell to a higher one, sorted by the two
  std::vector<double> area_, curvature_;  // of triangles
  std::vector<double> angle_, round_;     // of corners; their sums at vertices
  std::vector<char> on_border_;           // of the surface, for each vertex
};

}  // namespace meshpipe
