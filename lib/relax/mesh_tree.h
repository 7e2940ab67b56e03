// SPDX-License-Identifier: BSD-3-Clause
// What is known of the mesh from before, so that only what has changed is looked at again; for lib/relax/
// only.
#pragma once
#include <optional>
#include <utility>

#include "lib/core/bvh.h"
#include "lib/relax/state.h"

namespace meshpipe {

/// Has triangle t gone, or have its corners moved or their neighbors changed after `time`?
inline bool changed_since(const State& s, int t, int time) {
  if (s.mesh.dead(t)) return true;
  const auto [a, b, c] = s.mesh.tris[t];
  const std::vector<int>& changed = s.clocks.changed;
  return changed[a] > time || changed[b] > time || changed[c] > time;
}

/// A search tree of the mesh as it was when it was last asked for.
class MeshTree {
 public:
  MeshTree() = default;
  MeshTree(const MeshTree&) = delete;  // the tree has a reference to the mesh
  /// Brings it up to date.
  void renew(const State& s);
  const Bvh& tree() const { return *tree_; }
  const Mesh& mesh() const { return mesh_; }
  /// The triangle of the state that is triangle i here.
  int number(int i) const { return number_[i]; }
  int time() const { return time_; }  ///< -1: there is none
  void forget() { time_ = -1; }

 private:
  Mesh mesh_;
  std::vector<int> number_;
  std::optional<Bvh> tree_;
  int time_ = -1;
};

/// The pairs of triangles that intersect, at some time.
struct Crossings {
  std::vector<std::pair<int, int>> pairs;  ///< sorted
  int time = -1;
};
/// Brings the crossings up to date: those of triangles that have not changed are known.
void renew(Crossings& crossings, const State& s, MeshTree& search);

}  // namespace meshpipe
