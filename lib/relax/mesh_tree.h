// SPDX-License-Identifier: BSD-3-Clause
// What is known of the mesh from before, so that only changes are looked at; for lib/relax/ only.
#pragma once
#include <optional>
#include <utility>

#include "lib/core/bvh.h"
#include "lib/relax/state.h"

namespace meshpipe {

/// Returns whether triangle t is gone, or a corner has moved or got other neighbors, after `time`.
inline bool changed_since(const State& s, int t, int time) {
  if (s.mesh.dead(t)) return true;
  const auto [a, b, c] = s.mesh.tris[t];
  const std::vector<int>& changed = s.clocks.changed;
  return changed[a] > time || changed[b] > time || changed[c] > time;
}

/// A search tree of the mesh, which follows its changes: added triangles are in a second tree.
class MeshTree {
 public:
  MeshTree() = default;
  MeshTree(const MeshTree&) = delete;  // the trees have references to the meshes
  /// Brings the tree up to date. Searches refer to the mesh as it was at the last call.
  void renew(const State& s);
  /// Returns the nearest point of the triangles on this component of the reference, as Bvh::nearest does.
  /// Requires: it has some. `face` is a triangle of the state.
  Bvh::Hit nearest(Vec3 p, int component, double bound, double enough) const;
  /// Calls visit(t) as Bvh::overlapping does, with t a triangle of the state.
  template <class Visit>
  void overlapping(const Box& box, Visit&& visit) const {
    built_.tree->overlapping(box, [&](int i) {
      if (built_.component[i] != gone) visit(built_.number[i]);
    });
    if (added_.tree) added_.tree->overlapping(box, [&](int i) { visit(added_.number[i]); });
  }
  /// Returns the pairs of triangles that intersect (self_intersections), of those in the first tree.
  std::vector<std::pair<int, int>> intersections() const;
  /// Returns the triangles that are not in the first tree.
  const std::vector<int>& added() const { return added_.number; }
  /// Forgets the mesh: to be called before the tree is used with another.
  void forget() { triangles_ = time_ = -1; }

 private:
  struct Part {
    Mesh mesh;
    std::vector<int> number;     ///< its triangles in the state
    std::vector<int> component;  ///< of the reference, or `gone`: not to be searched
    std::optional<Bvh> tree;
    void build(const State& s, std::vector<int> triangles);
  };
  void build(const State& s);
  void follow(const State& s);

  static constexpr int gone = -1;
  Part built_, added_;
  int triangles_ = -1, time_ = -1;  ///< of the state, when the first was built; and that of the last renewal
};

/// The pairs of triangles that intersect, at some time.
struct IntersectingPairs {
  std::vector<std::pair<int, int>> pairs;  ///< sorted
  int time = -1;
};
/// Brings the intersecting pairs up to date: tests the triangles changed since `intersections.time`.
void renew(IntersectingPairs& intersections, const State& s, MeshTree& search);

}  // namespace meshpipe
