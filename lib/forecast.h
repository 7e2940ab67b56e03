// SPDX-License-Identifier: BSD-3-Clause
// What the conformal map of a region will look like, foreseen on a coarse model of the surface.
#pragma once
#include <vector>

#include "lib/cells.h"
#include "lib/mesh.h"

namespace meshpipe {

/// Of the conformal map that keeps the length of the region's longest loop (boundary first flattening).
struct Forecast {
  double unevenness = 1;  ///< largest over smallest area scale, 1 % of the area left out at either end
  int crossings = 0;      ///< of the outline with itself, where it is drawn with some hundred corners
};

/// The edges that a cell has in common with another, or with a border.
struct CellContact {
  int first = 0, last = 0;  ///< half-edges crossing[first..last) of the cells
  double length = 0;
  Vec3 middle,
      across;  ///< first moment; sum of the edges' normals outward in their triangles, of their lengths
  void add(const Mesh& mesh, int h);
  Vec3 place() const { return (1 / length) * middle; }
  /// The width for a flow in this direction: a ragged contact conducts like a straight one.
  double width(Vec3 direction) const;
};

/// Groups the triangles of a surface into some thousand cells, to solve for the scale of a region's map by
/// finite volumes with two-point fluxes: within a fifth of its logarithm, in a millisecond.
class Forecaster {
 public:
  /// Keeps references; `opposite` as opposite_halfedges gives it.
  Forecaster(const Mesh& mesh, const std::vector<int>& opposite);
  /// The map of the union of labels a and b (equal for one region). `border` holds the border half-edges of
  /// the union. Precondition: it maps to the plane (lib/regions.h).
  Forecast of(const std::vector<int>& label, int a, int b, const std::vector<int>& border) const;

 private:
  struct Bulk {  // of a cell, or of what lies in a region of it
    double area = 0, curvature = 0;
    Vec3 middle;  // first moment of the area
  };
  template <class Inside>
  Bulk gather(int cell, Inside inside) const;

  const Mesh& mesh_;
  const std::vector<int>& opposite_;
  std::vector<double> area_, curvature_;  // of triangles
  std::vector<double> angle_, round_;     // of corners; their sums at vertices
  std::vector<char> on_border_;           // of the surface, for each vertex
  Cells cells_;
  std::vector<int> start_, member_;  // triangles of a cell: member_[start_[c] .. start_[c + 1])
  std::vector<Bulk> whole_;
  std::vector<CellContact> contact_;
};

}  // namespace meshpipe
