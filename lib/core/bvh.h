// SPDX-License-Identifier: BSD-3-Clause
// A bounding-volume hierarchy over the triangles of a mesh: nearest point, and the triangles in a box.
#pragma once
#include <algorithm>
#include <bit>

#include "lib/core/chart.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns the barycentric coordinates of the point of triangle abc that is closest to p; a triangle without
/// area counts as its three edges. Source: Ericson, Real-Time Collision Detection, 5.1.5.
std::array<double, 3> closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c);
/// Returns the vector from p to the point of triangle abc with these barycentric coordinates. It is made of
/// those to the corners, which lose nothing far from the origin and are the same for all triangles there.
inline Vec3 vector_to(const std::array<double, 3>& weights, Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
  return weights[0] * (a - p) + weights[1] * (b - p) + weights[2] * (c - p);
}
/// Returns the place on triangle t of the mesh that is closest to p.
Place closest_place(const Mesh& mesh, int t, Vec3 p);
/// Returns the point of triangle t of the mesh that is closest to p.
Vec3 closest_point(const Mesh& mesh, int t, Vec3 p);

/// A box with sides along the axes.
struct Box {
  Vec3 lo, hi;
};
inline Box join(const Box& a, const Box& b) { return {lower(a.lo, b.lo), upper(a.hi, b.hi)}; }
inline Box box_of(const Mesh& mesh, int t) {
  const Vec3 &a = mesh.points[mesh.tris[t][0]], &b = mesh.points[mesh.tris[t][1]],
             &c = mesh.points[mesh.tris[t][2]];
  return {lower(lower(a, b), c), upper(upper(a, b), c)};
}
/// Returns the box of all triangles. Requires: there is one.
Box box_of(const Mesh& mesh);
/// Returns whether two boxes have a point in common. Without branches, which could not be predicted.
inline bool overlap(const Box& a, const Box& b) {
  return (a.lo.x <= b.hi.x) & (a.hi.x >= b.lo.x) & (a.lo.y <= b.hi.y) & (a.hi.y >= b.lo.y) &
         (a.lo.z <= b.hi.z) & (a.hi.z >= b.lo.z);
}

/// A tree of nodes with four children each, whose boxes are tested together. Built by median splits in
/// O(n log n), in parallel, the same tree at any number of threads. Queries do not allocate.
class Bvh {
 public:
  /// Keeps a reference to the mesh. Requires: it has a triangle.
  explicit Bvh(const Mesh& mesh);
  /// Fits the boxes to the mesh after its points or corners have changed, in linear time. Searches stay as
  /// fast as long as each triangle is near to where it was.
  void refit();
  struct Hit {
    double distance = 0;
    Place place;
  };
  /// Returns the nearest point of the mesh, or the first found within the distance `enough`. `bound`: an
  /// upper bound on the distance, if one is known; too small a bound costs time only.
  Hit nearest(Vec3 p, double bound = 1e300, double enough = 0) const;
  /// Returns the same; face -1 if none is within `bound`.
  Hit nearest_within(Vec3 p, double bound, double enough) const {
    return search(p, bound, enough, nullptr, 0);
  }
  /// Returns the same among triangles with label[t] == wanted.
  Hit nearest_of(const std::vector<int>& label, int wanted, Vec3 p, double bound, double enough) const;
  struct RayHit {
    double distance = 0;  ///< in lengths of the direction
    int face = -1;        ///< -1: none
    double b1 = 0, b2 = 0;
  };
  /// Returns the first triangle that the ray from p leaves through (side 1: along its normal) or enters
  /// through (-1: against it). Others do not stop the ray, which may slip through an edge.
  RayHit first_hit(Vec3 p, Vec3 direction, int side) const;
  /// Calls visit(t) for every triangle whose box overlaps the given one, and for some whose box nearly does.
  template <class Visit>
  void overlapping(const Box& box, Visit&& visit) const;
  /// Calls visit(t) for every triangle that has a point within `reach` of p in the cone around the unit
  /// vector `axis` where the cosine is at least `cosine` (not negative), and for some others; visit returns
  /// the reach from there on, which may not grow.
  template <class Visit>
  void in_cone(Vec3 p, Vec3 axis, double cosine, double reach, Visit&& visit) const;
  /// Returns the triangles in an order in which neighbors in space are close together.
  const std::vector<int>& order() const { return order_; }

 private:
  using Four = float __attribute__((vector_size(16)));
  using Mask = int __attribute__((vector_size(16)));
  /// Boxes in units of the mesh's half extent from its center, rounded outwards by `slack`; a child that is
  /// missing has an empty box.
  struct Node {
    Four lo[3], hi[3];
    int child[4];  ///< a node, or -1 - t for triangle t
  };
  struct Item;
  Box build(Item* items, int first, int count, int node);
  Hit search(Vec3 p, double bound, double enough, const int* label, int wanted) const;
  void set_child(int node, int k, int child, const Box& box);
  std::array<float, 3> own_units(Vec3 p) const;
  static constexpr float slack = 1e-6f;

  const Mesh& mesh_;
  Vec3 center_;
  double scale_ = 1;  ///< own units of a length
  std::vector<Node> nodes_;
  std::vector<int> order_;
};

template <class Visit>
void Bvh::overlapping(const Box& box, Visit&& visit) const {
  const auto lo = own_units(box.lo), hi = own_units(box.hi);
  int stack[64], n = 0;
  stack[n++] = 0;
  while (n) {
    const Node& b = nodes_[stack[--n]];
    Mask meets = (b.lo[0] <= hi[0]) & (b.hi[0] >= lo[0]);
    for (int k = 1; k < 3; ++k) meets &= (b.lo[k] <= hi[k]) & (b.hi[k] >= lo[k]);
    meets &= Mask{1, 2, 4, 8};
    // only as many turns as there are, since whether a child is met could not be predicted
    for (unsigned set = meets[0] | meets[1] | meets[2] | meets[3]; set; set &= set - 1) {
      const int k = std::countr_zero(set);
      if (b.child[k] < 0)
        visit(-1 - b.child[k]);
      else
        stack[n++] = b.child[k];
    }
  }
}

template <class Visit>
void Bvh::in_cone(Vec3 p, Vec3 axis, double cosine, double reach, Visit&& visit) const {
  constexpr float trust = 1 + 1e-5f, margin = 2e-6f;  // for rounding to single precision
  const auto q = own_units(p);
  const float d[3] = {(float)axis.x, (float)axis.y, (float)axis.z}, slope = (float)cosine / trust;
  auto squared = [&] {
    const float r = (float)std::min(reach * scale_, 1e17) * trust + margin;
    return r * r;
  };
  float most = squared();
  int stack[64], n = 0;
  stack[n++] = 0;
  while (n) {
    const Node& b = nodes_[stack[--n]];
    Four away{}, along = Four{} + margin;  // least squared distance, largest extent along the axis
    for (int k = 0; k < 3; ++k) {
      const Four lo = b.lo[k] - q[k], hi = b.hi[k] - q[k];
      Four out = lo > -hi ? lo : -hi;
      out = out > 0 ? out : Four{};
      away += out * out;
      along += d[k] > 0 ? d[k] * hi : d[k] * lo;
    }
    const Mask meets =
        (away <= most) & (along >= 0) & (along * along >= slope * slope * away) & Mask{1, 2, 4, 8};
    for (unsigned set = meets[0] | meets[1] | meets[2] | meets[3]; set; set &= set - 1) {
      const int k = std::countr_zero(set);
      if (b.child[k] < 0) {
        reach = visit(-1 - b.child[k]);
        most = squared();
      } else {
        stack[n++] = b.child[k];
      }
    }
  }
}

}  // namespace meshpipe
