// SPDX-License-Identifier: BSD-3-Clause
// Self-intersections of a mesh, exactly.
#pragma once
#include <limits>
#include <utility>

#include "lib/core/bvh.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Do two triangles of one mesh meet other than in the vertices or the edge that they share? Exact
/// predicates; sharing an edge they meet only if coplanar and on the same side, sharing a vertex if an
/// opposite edge meets the other.
bool triangles_intersect(const Mesh& mesh, int s, int t);

/// Has a triangle area, by exact arithmetic?
bool has_area(Vec3 a, Vec3 b, Vec3 c);
bool has_area(const Mesh& mesh, int t);

/// All intersecting pairs (s < t), sorted. Degenerate triangles (zero area) are left out, as they have no
/// plane.
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh);
/// The same with a tree at hand; one of each pair is among the first `own` triangles.
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, const Bvh& bvh,
                                                    int own = std::numeric_limits<int>::max());

/// Where the triangles of each pair meet: segments, as triangles (first, last, last); of triangles in one
/// plane, the polygon that they share.
Mesh contacts(const Mesh& mesh, const std::vector<std::pair<int, int>>& pairs);

/// Those of the intersecting pairs that meet farther than two of their edges from `known`, the contacts of
/// another mesh of the same surface: that one does not intersect there.
std::vector<std::pair<int, int>> new_intersections(const Mesh& mesh,
                                                   const std::vector<std::pair<int, int>>& pairs,
                                                   const Mesh& known);
/// The same with the contacts' tree at hand.
std::vector<std::pair<int, int>> new_intersections(const Mesh& mesh,
                                                   const std::vector<std::pair<int, int>>& pairs,
                                                   const Bvh& known);

}  // namespace meshpipe
