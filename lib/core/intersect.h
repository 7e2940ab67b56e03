// SPDX-License-Identifier: BSD-3-Clause
// Self-intersections of a mesh, exactly.
#pragma once
#include <limits>
#include <utility>

#include "lib/core/bvh.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns whether two triangles of one mesh meet other than in the vertices or the edge that they share, by
/// exact predicates: with a common edge, whether they are coplanar and on the same side of it; with a common
/// vertex, whether the edge opposite to it in one of them meets the other.
bool triangles_intersect(const Mesh& mesh, int s, int t);

/// Returns whether a triangle has area, by exact arithmetic.
bool has_area(Vec3 a, Vec3 b, Vec3 c);
bool has_area(const Mesh& mesh, int t);

/// Returns all pairs s < t of triangles that intersect, sorted. Triangles without area are left out.
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh);
/// Returns the same with the mesh's tree at hand: pairs with a triangle among the first `own`.
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, const Bvh& bvh,
                                                    int own = std::numeric_limits<int>::max());

/// Returns those of the intersecting pairs that also do if vertices at the same place are one: the others
/// only touch, as bodies do that share a vertex or an edge.
std::vector<std::pair<int, int>> crossings(Mesh mesh, std::vector<std::pair<int, int>> pairs);

/// Returns where the triangles of each pair meet, as triangles after `places`: a segment is (first, last,
/// last); for two triangles in one plane, the polygon that they share.
Mesh contacts(const Mesh& mesh, const std::vector<std::pair<int, int>>& pairs, Mesh places = {});

/// Adds to `places` where triangles lie on others: where they are parallel (to 8 degrees), and at least half
/// of their overlap is no farther from the other than `near`.
Mesh coincidences(const Mesh& mesh, double near, Mesh places);

/// Returns those of the intersecting pairs whose contact is, all along, farther than twice their longest edge
/// from `known`, the contacts of another mesh of the same surface: that mesh does not intersect there.
std::vector<std::pair<int, int>> new_intersections(const Mesh& mesh,
                                                   const std::vector<std::pair<int, int>>& pairs,
                                                   const Mesh& known);
/// Returns the same with the tree of the contacts at hand.
std::vector<std::pair<int, int>> new_intersections(const Mesh& mesh,
                                                   const std::vector<std::pair<int, int>>& pairs,
                                                   const Bvh& known);

}  // namespace meshpipe
