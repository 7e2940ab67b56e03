// SPDX-License-Identifier: BSD-3-Clause
// Estimates the distortion of a region's conformal map on a coarse model of the surface.
#pragma once
#include <vector>

#include "lib/core/mesh.h"
#include "lib/partition/aggregates.h"

namespace meshpipe {

/// Of the conformal map that keeps the length of the region's longest loop (boundary first flattening).
struct DistortionEstimate {
  double area_distortion = 1;  ///< largest over smallest area scale, 1 % of the area left out at either end
  int crossings = 0;           ///< of the outline with itself, where it is drawn with some hundred corners
};

/// The edges that an aggregate shares with another, or with a border.
struct Contact {
  int first = 0, last = 0;  ///< half-edges crossing[first..last) of the aggregates
  double length = 0;
  Vec3 middle;  ///< first moment
  Vec3 across;  ///< sum of the edges' normals outward in their triangles, times their lengths
  void add(const Mesh& mesh, int h);
  Vec3 place() const { return (1 / length) * middle; }
  /// The width for a flow in this direction: a ragged contact conducts like a straight one.
  double width(Vec3 direction) const;
};

/// A surface as some thousand aggregates of triangles, on which the scale of a region's map is found by
/// finite volumes with two-point fluxes: within a fifth of its logarithm, in a millisecond.
class DistortionModel {
 public:
  /// Keeps references to what `mesh` shows.
  explicit DistortionModel(const Connectivity& mesh);
  /// Estimates the map of the union of labels a and b (equal for one region), whose border half-edges are
  /// given. Requires: the union maps to the plane (lib/core/regions.h).
  DistortionEstimate of(const std::vector<int>& label, int a, int b, const std::vector<int>& border) const;

 private:
  struct Moments {  // of an aggregate, or of what lies in a region of it
    double area = 0, curvature = 0;
    Vec3 middle;  // first moment of the area
  };
  struct Region;
  template <class Inside>
  Moments gather(int aggregate, Inside inside) const;
  template <class Inside>
  Region take_region(const std::vector<int>& border, Inside inside) const;
  template <class Inside>
  std::vector<double> turns_of(const std::vector<int>& loop, Inside inside, Region& region) const;
  template <class Inside>
  void solve_scale(const std::vector<Contact>& with_rim, Inside inside, Region& region) const;

  const Mesh& mesh_;
  const std::vector<int>& opposite_;
  std::vector<double> area_, curvature_;   // of triangles
  std::vector<double> angle_, angle_sum_;  // of corners; of vertices
  std::vector<char> on_border_;            // of the surface, for each vertex
  Aggregates aggregates_;
  std::vector<int> start_, member_;  // triangles of aggregate g: member_[start_[g] .. start_[g + 1])
  std::vector<Moments> whole_;
  std::vector<Contact> contact_;
};

}  // namespace meshpipe
