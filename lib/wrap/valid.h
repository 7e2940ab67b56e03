// SPDX-License-Identifier: BSD-3-Clause
// What keeps a closed mesh around a soup valid: without intersections, with the soup inside.
#pragma once
#include <cstdint>
#include <functional>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Moves points of `mesh` back towards `base`, in steps, until the mesh neither intersects itself nor the
/// soup, has no fins or cracks narrower than `least`, and encloses the soup: triangles within `reach` of a
/// point of the soup that is outside move, too. Returns the number of points moved. Requires: the mesh at the
/// points `base` is so.
int keep_valid(Mesh& mesh, const std::vector<Vec3>& base, const Mesh& soup, double reach, double least);

/// Tells whether points are strictly inside a closed mesh, by the side of the nearest triangle, edge or
/// vertex. Source: angle-weighted normals (Baerentzen and Aanaes 2005).
class InsideTest {
 public:
  /// Keeps references to the mesh, its opposite half-edges and the tree.
  InsideTest(const Connectivity& mesh, const Bvh& tree);
  bool inside(Vec3 p) const;

 private:
  Connectivity mesh_;
  const Bvh& tree_;
  std::vector<Vec3> face_normal_, vertex_normal_;
};

/// Returns a copy of the soup in which each triangle without area is a sliver of this width along its longest
/// edge: exact tests need an area.
Mesh with_area(const Mesh& soup, double width);

/// Returns per triangle of `wrap` whether it intersects one of the soup (exact); 0 where `wanted`, per
/// triangle of `wrap` or empty, is 0. Requires: triangles of the soup have area.
std::vector<std::uint8_t> triangles_that_meet(const Mesh& wrap, const std::vector<std::uint8_t>& wanted,
                                              const Mesh& soup);

/// Flags the triangles that intersect another one of the mesh (exact), or are sides of a fin or crack
/// narrower than `least`, if one of the two is wanted (`wanted`: per triangle).
std::vector<std::uint8_t> triangles_that_meet_others(const Mesh& mesh,
                                                     const std::vector<std::uint8_t>& wanted, double least);

/// Contracts short edges (`spacing`: the length of regular ones) and flips long ones at slivers, as long as
/// normals hardly turn, the mesh stays valid as in keep_valid (`least`: as there), and allowed(mesh, t) holds
/// for each changed triangle t. Requires: the mesh is valid, the soup's triangles have area.
void remove_slivers(Mesh& mesh, const Mesh& soup, double spacing, double least,
                    const std::function<bool(const Mesh&, int)>& allowed);

}  // namespace meshpipe
