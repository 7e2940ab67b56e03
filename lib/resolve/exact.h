// SPDX-License-Identifier: BSD-3-Clause
// Points of an arrangement of triangles, exactly: vertices of the input, and points where lines through them
// meet planes and each other.
#pragma once
#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

#include "lib/core/mesh.h"
#include "lib/core/weld.h"

namespace meshpipe {

/// The two coordinates in which a plane is seen: 0 x, 1 y, 2 z.
struct Projection {
  int i = 0, j = 1;
};

/// Numbered points with rational coordinates, each only once, and the signs of their determinants: by a
/// floating-point filter on the rounded coordinates, then in integers.
class ExactPoints {
 public:
  /// Takes the vertices as the first points; new points are compared with those with used[v] != 0. Requires:
  /// vertices with the same coordinates are one.
  ExactPoints(std::vector<Vec3> vertices, const std::vector<char>& used);

  int size() const { return (int)near_.size(); }
  bool is_vertex(int p) const { return p < vertices_; }
  /// Returns the point with each coordinate rounded to the nearest double.
  const Vec3& near(int p) const { return near_[p]; }

  /// Returns coordinates in which triangle `t` is seen to turn left. Requires: `t` has area.
  Projection view(const Tri& t) const;

  /// Returns the point where the line through vertices p and q meets the plane of vertices `t`.
  int line_and_plane(int p, int q, const Tri& t);
  /// Returns the point where the lines p q and a b of one plane meet. Requires: not parallel as seen.
  int line_and_line(int p, int q, int a, int b, Projection view);

  /// Returns +1 if a, b, c turn left as seen, -1 if right, 0 if they are collinear.
  int turn(int a, int b, int c, Projection view) const;
  /// Returns +1 if p lies where vertices `t` are seen to turn left, -1 if behind their plane, 0 if in it.
  int side(const Tri& t, int p) const;
  /// Returns the sign of q - p in coordinate k.
  int compare(int p, int q, int k) const;

 private:
  using Int = boost::multiprecision::cpp_int;
  /// x y z w with w > 0, coordinates in units of 2^exponent_.
  using Homogeneous = std::array<Int, 4>;
  Homogeneous exact(int p) const;
  Homogeneous plane(const Tri& t) const;
  Vec3 rounded(const Homogeneous& h) const;
  int number(Homogeneous h);

  int vertices_;
  int exponent_ = 0;
  double error_ = 0;  ///< most that a rounded coordinate is off
  std::vector<Vec3> near_;
  std::vector<Homogeneous> new_;         ///< points after the vertices
  PointNumbers places_;                  ///< of rounded points
  std::vector<int> first_at_, next_at_;  ///< points with the same rounded place: of places, of points
};

}  // namespace meshpipe
