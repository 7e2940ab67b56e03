// SPDX-License-Identifier: BSD-3-Clause
// Walks on a surface to the nearest place to a point, from a place close by.
#pragma once
#include <cstdint>

#include "lib/core/chart.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Walks over a surface from triangle t across edges as long as that comes closer to p, until it is within
/// `enough`; t becomes the last triangle. Returns its distance from p.
double walk_to(Vec3 p, const std::vector<Vec3>& points, const std::vector<Tri>& tris,
               const std::vector<int>& opposite, int& t, double enough = 0);

/// A surface to walk on, whose borders and feature edges bound walks.
class SurfaceWalk {
 public:
  /// Takes an oriented manifold, to which it keeps a reference, and the bits of its feature edges as in face
  /// column `model` (empty: none). Throws: as opposite_halfedges.
  SurfaceWalk(const Mesh& mesh, const std::vector<std::uint8_t>& model);
  /// Walks from `from` to neighboring triangles as long as they come closer to `target`. Returns the place
  /// reached, a local minimum of the distance that is connected to `from` on the surface: the walk never
  /// jumps to another sheet. Never fails. With `through_features`, only borders bound the walk.
  Place closest(const Place& from, Vec3 target, bool through_features = false) const;
  /// Slides from `from`, on a border or feature edge, along its line towards `target`, not past an end of the
  /// line or a junction. Returns the place reached; `from` itself if it is on no such line.
  Place slide(const Place& from, Vec3 target) const;
  /// Slides from `from`, a vertex, along a line that leads to the vertex at `to`; without one, as above.
  Place slide(const Place& from, const Place& to, Vec3 target) const;
  /// Returns the same point as a place of the triangle on the other side of the feature edge on which it
  /// lies; the place itself if it lies on none.
  Place across(const Place& place) const;
  Vec3 point(const Place& place) const;
  /// Returns opposite_halfedges of the mesh.
  const std::vector<int>& opposite() const { return opposite_; }
  /// Returns the unit normal of the triangle at a place.
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
