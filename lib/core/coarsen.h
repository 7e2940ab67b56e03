// SPDX-License-Identifier: BSD-3-Clause
// A coarse model of a surface with the same topology, for decisions that need no detail.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// What contractions may do.
struct CoarsenLimits {
  /// Radians by which a triangle may turn from the surface's normals at its corners, or as much as before:
  /// with 25 degrees, tubes keep about seven edges around them.
  double turn;
  double length =
      infinity;  ///< of edges; longer ones may grow by as much in square. No triangle becomes thin
  /// Per vertex: root mean square distance from the planes that become one with it; empty: no limit.
  std::vector<double> deviation{};
  std::vector<char> fixed{};  ///< per vertex: it stays; empty: none
};

/// A surface some of whose edges were contracted, each by the link condition: the vertices that became one
/// are connected, so a cut along coarse edges can be transferred to the surface with the same topology.
struct Coarse : Mesh {
  std::vector<std::uint8_t> model;  ///< bits of model edges, as of the surface
  std::vector<int> vertex;          ///< of each coarse vertex: the vertex that it is
  std::vector<int> face;            ///< of each coarse triangle: the triangle that has become it
  std::vector<double> deviation;    ///< of each coarse vertex, if that has limits
  std::vector<int> of;  ///< of each vertex: the coarse vertex it has become; -1: it has no triangle
};

/// Contracts short edges in rounds, in each of which a vertex takes in at most one other, until at most
/// `wanted` triangles are left or a round removes less than a fifth. Density follows that of the mesh;
/// borders and model edges stay, and their corners. Requires: an oriented manifold without
/// pinched vertices that has a triangle.
Coarse coarsen(const Connectivity& c, int wanted, const CoarsenLimits& limits);

}  // namespace meshpipe
