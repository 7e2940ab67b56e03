// SPDX-License-Identifier: BSD-3-Clause
// Walks on a surface to the nearest place to a point, from a place close by.
#pragma once
#include <cstdint>

#include "lib/core/chart.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Walks over a surface from triangle t, which becomes the last, across edges, as long as that comes closer
/// to p or until it is within `enough`. Returns the distance of p from it, an upper bound of that from the
/// surface.
double walk_to(Vec3 p, const std::vector<Vec3>& points, const std::vector<Tri>& tris,
               const std::vector<int>& opposite, int& t, double enough = 0);

/// A surface to walk on. Borders and feature edges (marked in `model`, as face column `model`) bound walks.
class SurfaceWalk {
 public:
  /// Requires: an oriented manifold. Keeps a reference to the mesh.
  SurfaceWalk(const Mesh& mesh, const std::vector<std::uint8_t>& model);
  /// Walks from `from` to neighboring triangles as long as they come closer to `target`; the result is
  /// connected to `from` on the surface, so that the walk never jumps to another sheet. Never fails; a local
  /// minimum is a valid answer. With `through_features`, only borders bound the walk.
  Place closest(const Place& from, Vec3 target, bool through_features = false) const;
  /// Slides from `from`, on a border or feature edge, along its line towards `target`, not past an end of the
  /// line or a junction. Returns a place on no such line as it is.
  Place slide(const Place& from, Vec3 target) const;
  /// The same from a vertex, on a line that comes to the vertex at `to`, if there is one.
  Place slide(const Place& from, const Place& to, Vec3 target) const;
  /// Returns the same point on the other side of the feature edge it lies on, or the place itself if it lies
  /// on none.
  Place across(const Place& place) const;
  Vec3 point(const Place& place) const;
  /// Unit normal of the triangle at a place.
  Vec3 normal(const Place& place) const { return normals_[place.face]; }

 private:
  double squared_distance(int h, Vec3 target, double& t) const;
  int next_on_line(int h, bool forward) const;
  std::vector<int> lines_at(int t, int i) const;
  Place slide_along(int line, Vec3 target) const;

  const Mesh& mesh_;
  std::vector<int> opposite_;
  std::vector<int> beyond_;  ///< the same, -1 along feature edges
  std::vector<Vec3> normals_;
  std::vector<std::uint8_t> degree_;  ///< borders and feature edges at a vertex, counted up to 3
};

}  // namespace meshpipe
