// SPDX-License-Identifier: BSD-3-Clause
// Moving over a reference surface: the nearest place to a point, by descent from a place close by.
#pragma once
#include <cstdint>

#include "lib/chart.h"
#include "lib/mesh.h"

namespace meshpipe {

/// A surface to walk on: borders and edges marked in `model` (bit i: the edge from corner i to i+1; empty:
/// none) are walls.
class SurfaceWalk {
 public:
  /// Precondition: an oriented manifold. Keeps a reference to the mesh.
  SurfaceWalk(const Mesh& mesh, const std::vector<std::uint8_t>& model);
  /// The place reached from `from` by steps to neighbouring triangles that come closer to `target`: it is
  /// connected to `from` on the surface, so the walk never jumps to another sheet. Never fails; a local
  /// minimum is a valid answer. `through_walls`: as if there were no walls inside the surface.
  Place closest(const Place& from, Vec3 target, bool through_walls = false) const;
  /// The place reached from `from`, which lies on a wall, by sliding along the wall towards `target`. Stops
  /// where the wall ends or others meet it. A place that is not on a wall is returned as it is.
  Place slide(const Place& from, Vec3 target) const;
  /// The same point on the other side of the wall it lies on; a place that is on no wall inside the surface
  /// stays.
  Place across(const Place& place) const;
  Vec3 point(const Place& place) const;
  /// Unit normal of the triangle at a place.
  Vec3 normal(const Place& place) const { return normals_[place.face]; }

 private:
  const Mesh& mesh_;
  std::vector<int> opposite_;   ///< opposite half-edge
  std::vector<int> neighbour_;  ///< the same, -1 at walls
  std::vector<Vec3> normals_;
  std::vector<std::uint8_t> walls_at_;  ///< number of walls that meet at a vertex, counted up to 3
};

}  // namespace meshpipe
