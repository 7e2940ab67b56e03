// SPDX-License-Identifier: BSD-3-Clause
// Points of an arrangement of triangles, exactly: vertices of the input, and points where lines through them
// meet planes and each other.
#pragma once
#include <boost/multiprecision/cpp_int.hpp>
#include <span>
#include <vector>

#include "lib/core/mesh.h"
#include "lib/core/weld.h"

namespace meshpipe {

/// Two coordinates that a plane is seen in: 0 x, 1 y, 2 z.
struct Projection {
  int i = 0, j = 1;
};

/// Numbered points with rational coordinates, each only once, and the signs of their determinants: by a
/// floating-point filter on the rounded coordinates, then in integers.
class ExactPoints {
 public:
  /// The first points are `vertices`; new points are compared with those that are `used`. Requires:
  /// vertices with the same coordinates are one.
  ExactPoints(std::vector<Vec3> vertices, const std::vector<char>& used);

  int size() const { return (int)near_.size(); }
  bool is_vertex(int p) const { return p < vertices_; }
  /// The point with each coordinate rounded to the nearest double.
  const Vec3& near(int p) const { return near_[p]; }

  /// Returns coordinates to see triangle `t` in, such that it turns left. Requires: `t` has area.
  Projection view(const Tri& t) const;

  /// Returns the point where the line through vertices p, q meets the plane of vertices `t`.
  int line_and_plane(int p, int q, const Tri& t);
  /// Returns the point where the lines p q and a b of one plane meet, which are not parallel as seen.
  int line_and_line(int p, int q, int a, int b, Projection view);

  /// +1 if a, b, c turn left as seen, -1 right, 0 collinear.
  int turn(int a, int b, int c, Projection view) const;
  /// +1 if p lies on the side of the plane of vertices `t` from which they turn left, -1 on the other, 0 on
  /// it.
  int side(const Tri& t, int p) const;
  /// The sign of the difference q - p of coordinate k.
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
