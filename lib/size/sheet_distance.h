// SPDX-License-Identifier: BSD-3-Clause
// The sheets of a surface that face each other: across a tube, a body between two sides, a gap.
#pragma once
#include <vector>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Returns the angle of the surface at an edge, behind its triangles, in degrees; 180 where it is flat.
double angle_behind(const Connectivity& surface, int half_edge);

/// Measures by rays how far the sheet is that faces each vertex, on one side of the surface: the radius of
/// the ball that touches the surface at the vertex and the opposite sheet. In a tube that is its radius,
/// between parallel sheets half their distance; at creases it is the smallest of their sides. Next to folds,
/// where two sides meet at less than 75 degrees, and where branches meet, it is that of the neighborhood.
class SheetDistance {
 public:
  enum Side { inside, outside };
  /// Copies the surface and measures. The inside of closed components is behind their triangles, that of open
  /// ones where they would enclose a volume. `none`: the radius where no sheet faces a vertex, and the
  /// largest one.
  SheetDistance(const Connectivity& surface, Side side, double none);
  SheetDistance(const SheetDistance&) = delete;
  /// Returns the radius per vertex.
  const std::vector<double>& radii() const { return radius_; }
  /// Returns the radius at a point of the surface.
  double radius_at(Vec3 p) const;

 private:
  Vec3 normal_at(int face, double b1, double b2) const;
  /// A ball at a point, whether rays to all directions find about the same, and whether it touches sheets
  /// that are far from parallel.
  struct Ball {
    double radius;
    bool sure = false, slanted = false;
  };
  Ball ball(Vec3 p, Vec3 normal) const;
  /// Returns the ball at a point of face t near its corner p, for creases, where vertices have no normal.
  Ball ball_on_face(int t, Vec3 p) const;
  /// Returns the smallest radius at point p on the sides of a crease there, of which face t is one.
  double ball_on_sides(int t, Vec3 p) const;
  void measure();
  void close_openings(const Connectivity& surface);
  void leave_sides(const Connectivity& surface, const std::vector<char>& fold, std::vector<double> reach);
  void leave_folds(const Connectivity& surface);
  void leave_branchings(const Connectivity& surface);
  /// Returns the angle of the surface at an edge, on the side that is measured, in degrees.
  double angle_on_side(const Connectivity& surface, int half_edge) const;

  Mesh mesh_;                        ///< with all components oriented outward
  std::vector<Vec3> face_, vertex_;  ///< unit normals, those of vertices averaged over a neighborhood
  Bvh tree_;
  Side side_;
  double none_;
  std::vector<double> radius_;
  std::vector<char> creased_;
  std::vector<char> folded_;   ///< vertices that have what their neighbors have
  std::vector<char> sure_;     ///< vertices at which rays agree
  std::vector<char> slanted_;  ///< creased vertices with a ball between sheets that are not parallel
};

}  // namespace meshpipe
