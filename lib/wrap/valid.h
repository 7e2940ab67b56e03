// SPDX-License-Identifier: BSD-3-Clause
// What keeps a closed mesh around a soup valid: without intersections, with the soup inside.
#pragma once
#include <cstdint>
#include <functional>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Moves points of `mesh` back towards `base`, in steps, until the mesh neither meets itself nor the soup nor
/// has fins or cracks narrower than `least`, and the soup is inside. Returns the number of points moved.
/// Requires: the mesh at the points `base` has these properties.
int keep_valid(Mesh& mesh, const std::vector<Vec3>& base, const Mesh& soup, double reach, double least);

/// Answers whether points are strictly inside a closed mesh, by the side of the nearest triangle, edge or
/// vertex. Source: angle-weighted normals (Baerentzen and Aanaes 2005).
class InsideTest {
 public:
  /// Keeps references to the mesh, its opposites and the tree.
  InsideTest(const Connectivity& mesh, const Bvh& tree);
  bool inside(Vec3 p) const;

 private:
  Connectivity mesh_;
  const Bvh& tree_;
  std::vector<Vec3> face_normal_, vertex_normal_;
};

/// Returns a copy of the soup in which each triangle without area is a sliver of this width along its longest
/// edge, since exact tests need an area.
Mesh with_area(const Mesh& soup, double width);

/// Returns per triangle of `wrap` whether it meets one of the soup (exact); 0 where `wanted`, if not empty,
/// is 0. Requires: triangles of the soup have area.
std::vector<std::uint8_t> triangles_that_meet(const Mesh& wrap, const std::vector<std::uint8_t>& wanted,
                                              const Mesh& soup);

/// Marks the triangles of the mesh that meet another one other than in shared vertices or edges (exact), or
/// are sides of a fin or crack narrower than `least`, where one of the two is wanted.
std::vector<std::uint8_t> triangles_that_meet_others(const Mesh& mesh,
                                                     const std::vector<std::uint8_t>& wanted, double least);

/// Contracts short edges and flips long ones at slivers, as long as normals hardly turn, the mesh neither
/// meets itself nor the soup nor gets narrower than `least`, and allowed(mesh, t) is true for each changed
/// triangle t. Requires: the mesh is valid, the soup's triangles have area.
void remove_slivers(Mesh& mesh, const Mesh& soup, double spacing, double least,
                    const std::function<bool(const Mesh&, int)>& allowed);

}  // namespace meshpipe
