// SPDX-License-Identifier: BSD-3-Clause
// A coarse model of a surface with the same topology, for decisions that need no detail.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// A surface some of whose edges have been contracted one after another, each by the link condition: so the
/// vertices that have become one are connected, and what the coarse surface is cut into has the topology of
/// what the surface is cut into along the same vertices.
struct Coarse : Mesh {
  std::vector<int> vertex;  ///< of each coarse vertex: the vertex that it is
  std::vector<int> face;    ///< of each coarse triangle: the triangle that has become it
  std::vector<int> of;      ///< of each vertex: the coarse vertex it has become
};

/// Contracts short edges in rounds, in each of which a vertex takes in at most one other, until no more than
/// `wanted` triangles are left or little more can be done: density follows that of the mesh, but no triangle
/// turns from the mesh's normals at its corners by more than `most_turn` (radians), or the more than it did:
/// with 25 degrees, tubes keep about seven edges around them. Borders and model edges keep their lines.
/// Requires: an oriented manifold without pinched vertices.
Coarse coarsen(const Connectivity& c, int wanted, double most_turn);

}  // namespace meshpipe
