// SPDX-License-Identifier: BSD-3-Clause
// The arrangement of segments within one triangle, triangulated, in exact arithmetic.
#pragma once
#include <vector>

#include "lib/resolve/exact.h"
#include "lib/resolve/plane_triangulation.h"

namespace meshpipe {

/// A triangulation of a triangle, into which points and segments are inserted. One object serves many
/// triangles in turn, so that memory is reused.
class TriangleArrangement {
 public:
  explicit TriangleArrangement(ExactPoints& points) : points_(points) {}
  /// Starts with one triangle. Requires: it has area.
  void start(const Tri& corners);
  /// Makes point p a vertex. Throws: Error if it does not lie on the triangle.
  void insert(int p);
  /// Makes the segment between two vertices a chain of fixed edges, with new vertices where it crosses other
  /// fixed edges. Throws: Error if it leaves the triangle.
  void insert(int p, int q);
  /// Flips free edges towards a Delaunay triangulation, by rounded coordinates.
  void improve();
  /// Returns the triangulation, oriented as the corners; the sides of the triangle are fixed.
  const PlaneTriangulation& mesh() const { return mesh_; }

 private:
  int turn(int a, int b, int c) const { return points_.turn(a, b, c, view_); }
  bool ahead(int p, int q, int r) const;
  bool can_flip(int h) const;
  void improve(std::vector<int> todo);
  int locate(int p, int& on) const;
  void clear_way(int p, int q, const std::vector<std::array<int, 2>>& crossed);
  int step(int p, int on_line);

  ExactPoints& points_;
  PlaneTriangulation mesh_;
  Projection view_;
  std::vector<std::array<int, 2>> lines_;  ///< two points on each
  int last_ = 0;                           ///< a triangle of the point inserted last
};

}  // namespace meshpipe
