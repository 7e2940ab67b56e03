// SPDX-License-Identifier: BSD-3-Clause
// What curves may move in: a neighborhood of theirs, and whether the parts in it stay what they are as
// wholes.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "lib/core/neighborhood.h"
#include "lib/partition/curves.h"

namespace meshpipe {

/// Curves that are straightened together, with all that moves with them: the connected triangles within some
/// rings of them. The face column `part` has numbers of its own.
struct CurveNeighborhood : Neighborhood {
  std::vector<Handle> handles{};  ///< of the curves, sorted
  std::vector<int> parts{};       ///< of each part, the number in the whole
  std::vector<int> allowed{};     ///< of each part, the triangles that it may have here
  /// Half-edges to a triangle of the same part outside, ascending. Cuts leave them as they are: no band has
  /// more rings than were taken, and their triangles have no vertex within these.
  std::vector<int> anchors{};
  int n_parts() const { return (int)parts.size(); }
  CutSurface cut() { return {surface, opposite}; }
};

/// Takes the neighborhoods of curves within a number of rings of triangles; curves near each other share
/// them. `max_faces`: the most triangles of a part of the whole, or 0: any number.
std::vector<CurveNeighborhood> take_curve_neighborhoods(const CutSurface& cut,
                                                        const std::vector<Curve>& curves, int rings,
                                                        int max_faces);

/// Puts a neighborhood of curves back, with the numbers that parts have in the whole. Requires: as put_back.
void put_back(CurveNeighborhood near, const CutSurface& cut);

/// The topology of a part in a neighborhood.
struct PartTopology {
  int faces = 0, pieces = 0;
  int genus = 0;    ///< the sum over the pieces
  int pinches = 0;  ///< how often it touches itself
};
struct PartTopologies {
  std::vector<int> piece;  ///< of each triangle
  std::vector<PartTopology> part;
  std::vector<int> next;  ///< of each anchor, the next one on the border of its part
};
/// Measures the parts (`part`: per triangle) of a neighborhood, which may have been cut.
PartTopologies topology_of_parts_in(const CurveNeighborhood& near, const Connectivity& mesh,
                                    const std::vector<int>& part);

/// Flags the parts that as a whole may no longer map to the plane, as they did: the pieces that are attached
/// to the rest, or the order of the anchors along their borders, are no longer the same, or there are other
/// pieces, or their genus has changed, or they touch themselves more often. Also those with more triangles
/// than are allowed.
std::vector<char> broken_parts(const PartTopologies& before, const PartTopologies& now,
                               const std::vector<int>& part, const CurveNeighborhood& near);

/// Lets the owners of vertices (`owner`, 0 or more) take vertices of nobody (-1) for a number of rings: in
/// each ring, the triangles with a vertex of the ring before, in their order, give theirs to their highest
/// owner where may_own(t, owner). `leaving`: half-edges that leave the owned vertices. Linear in the
/// triangles reached.
template <class MayOwn>
void grow_owners(const Connectivity& c, std::vector<int> leaving, int rings, std::vector<int>& owner,
                 MayOwn may_own) {
  std::vector<char> seen(c.n_tris(), 0);
  std::vector<int> tris;
  std::vector<std::pair<int, int>> claims;  // a half-edge that leaves the vertex, and the owner
  for (int ring = 0; ring < rings && !leaving.empty(); ++ring) {
    tris.clear();
    for (int h : leaving)
      if (owner[c.from(h)] >= 0)
        c.for_each_spoke(h, [&](int g) {
          if (!seen[g / 3]) tris.push_back(g / 3);
          seen[g / 3] = 1;
        });
    std::sort(tris.begin(), tris.end());
    claims.clear();
    for (int t : tris) {
      const Tri& v = c.mesh.tris[t];
      const int most = std::max({owner[v[0]], owner[v[1]], owner[v[2]]});
      for (int i = 0; i < 3; ++i)
        if (owner[v[i]] == -1 && may_own(t, most)) claims.push_back({3 * t + i, most});
    }
    leaving.clear();
    for (auto [h, o] : claims) {
      if (owner[c.from(h)] != -1) continue;
      owner[c.from(h)] = o;
      leaving.push_back(h);
    }
  }
}

}  // namespace meshpipe
