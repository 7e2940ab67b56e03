// SPDX-License-Identifier: BSD-3-Clause
// A bounding-volume hierarchy over the triangles of a mesh: nearest point, and pairs of triangles whose boxes overlap.
#pragma once
#include <functional>

#include "lib/chart.h"
#include "lib/mesh.h"

namespace meshpipe {

/// Closest point of triangle abc to p, as barycentric coordinates (Ericson, Real-Time Collision Detection, 5.1.5).
std::array<double, 3> closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

class Bvh {
 public:
  explicit Bvh(const Mesh& mesh);  ///< keeps a reference to the mesh
  struct Hit {
    double distance = 0;
    Place place;
  };
  /// Nearest point of the mesh; `bound` is an upper bound on the distance that is already known.
  Hit nearest(Vec3 p, double bound = 1e300) const;
  /// Calls visit(t) for every triangle whose box overlaps [lo, hi].
  void overlapping(Vec3 lo, Vec3 hi, const std::function<void(int)>& visit) const;

 private:
  struct Node {
    Vec3 lo, hi;
    int first, count;  ///< count > 0: leaf with triangles order_[first..]; else children first, first + 1
  };
  const Mesh& mesh_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace meshpipe
