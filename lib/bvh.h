// SPDX-License-Identifier: BSD-3-Clause
// A bounding-volume hierarchy over the triangles of a mesh: nearest point, and the triangles in a box.
#pragma once
#include <algorithm>

#include "lib/chart.h"
#include "lib/mesh.h"

namespace meshpipe {

/// Closest point of triangle abc to p, as barycentric coordinates (the regions of Ericson, Real-Time
/// Collision Detection, 5.1.5). A triangle without area counts as its three edges.
std::array<double, 3> closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

/// A box with sides along the axes.
struct Box {
  Vec3 lo, hi;
};
inline Vec3 lower(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
inline Vec3 upper(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
inline Box join(const Box& a, const Box& b) { return {lower(a.lo, b.lo), upper(a.hi, b.hi)}; }
inline Box box_of(const Mesh& mesh, int t) {
  const Vec3 &a = mesh.points[mesh.tris[t][0]], &b = mesh.points[mesh.tris[t][1]],
             &c = mesh.points[mesh.tris[t][2]];
  return {lower(lower(a, b), c), upper(upper(a, b), c)};
}
/// Without branches, as they could not be predicted.
inline bool overlap(const Box& a, const Box& b) {
  return (a.lo.x <= b.hi.x) & (a.hi.x >= b.lo.x) & (a.lo.y <= b.hi.y) & (a.hi.y >= b.lo.y) &
         (a.lo.z <= b.hi.z) & (a.hi.z >= b.lo.z);
}

/// Built by median splits in O(n log n), in parallel, the same tree at any number of threads. Queries do not
/// allocate.
class Bvh {
 public:
  /// Keeps a reference to the mesh. Precondition: it has a triangle.
  explicit Bvh(const Mesh& mesh);
  struct Hit {
    double distance = 0;
    Place place;
    int leaf = 0;  ///< where in the tree
  };
  /// Nearest point of the mesh; `bound` is an upper bound on the distance that is already known.
  Hit nearest(Vec3 p, double bound = 1e300) const;
  /// The same for a point close to one that was asked before: climbs from that one's leaf.
  Hit nearest(Vec3 p, const Hit& close_by) const;
  /// Calls visit(t) for every triangle that may overlap the box: those of every leaf that does.
  template <class Visit>
  void overlapping(const Box& box, Visit&& visit) const;
  /// The triangles, neighbours in space close together.
  const std::vector<int>& order() const { return order_; }

 private:
  struct Node {
    Box box;
    int first, count;  ///< count > 0: leaf with triangles order_[first..]; else children first, first + 1
  };
  struct Item;
  void build(Item* items, int first, int count, int node, int children);
  void search(int node, const Vec3& p, double& best, Hit& hit) const;
  const Mesh& mesh_;
  std::vector<Node> nodes_;  ///< the root is 0; siblings are an odd number and the next one
  std::vector<int> parent_;
  std::vector<int> order_;
};

template <class Visit>
void Bvh::overlapping(const Box& box, Visit&& visit) const {
  int stack[64], n = 0;
  stack[n++] = 0;
  while (n) {
    const Node& b = nodes_[stack[--n]];
    if (!overlap(b.box, box)) continue;
    if (b.count) {
      for (int i = b.first; i < b.first + b.count; ++i) visit(order_[i]);
    } else {
      stack[n++] = b.first;
      stack[n++] = b.first + 1;
    }
  }
}

}  // namespace meshpipe
