// SPDX-License-Identifier: BSD-3-Clause
// A surface while it is repaired: what the steps of lib/clean.h pass to each other.
#pragma once
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// Where each triangle and vertex came from, and neighbours across edges of two triangles.
struct Repair {
  std::vector<Tri> tris;
  std::vector<int> face;      ///< triangle of the input; of one that fills a hole ~ the one it is a copy of
  std::vector<int> vertex;    ///< vertex of the input; copies made by splitting come last
  std::vector<int> copied;    ///< the vertex each of them is a copy of
  std::vector<int> opposite;  ///< half-edges; may run the same way until the surface is oriented
  std::vector<char> split;    ///< vertices of non-manifold edges
  std::vector<char> flipped;  ///< triangles turned round
};

/// The vertex that v is, or is a copy of.
inline int base(const Repair& r, int v) {
  const int n = (int)(r.vertex.size() - r.copied.size());
  return v < n ? v : r.copied[v - n];
}

/// The triangle of the input whose columns triangle t has.
inline int source(const Repair& r, int t) { return r.face[t] < 0 ? ~r.face[t] : r.face[t]; }

/// Leaves out the triangles with gone != 0, the others keep their order; what they bordered on becomes
/// border.
void drop(Repair& r, const std::vector<char>& gone);

/// Calls visit(g) for the half-edges g that leave the origin of h, one for each triangle of its fan; returns
/// whether the fan is closed. Precondition: an oriented manifold.
template <class Visit>
bool for_each_spoke(const Repair& r, int h, Visit visit) {
  const int seed = h;
  do {
    visit(h);
    h = r.opposite[prev(h)];
  } while (h >= 0 && h != seed);
  if (h == seed) return true;
  for (h = r.opposite[seed]; h >= 0; h = r.opposite[h]) visit(h = next(h));
  return false;
}

/// Turns a triangle round: its half-edges 0 1 2 become 2 1 0.
void turn(Repair& r, int t);

/// Makes closed components face out of what they enclose: outward, or inward where they lie within an odd
/// number of others. Nothing is turned among components within one another that all face outward, as they may
/// be solids each, nor where signed volume or place are unclear (one lies on another). `component` of every
/// triangle, 0 <= component < n. Time: a ray through the surface for each of a few vertices of a component.
void face_outward(Repair& r, const std::vector<Vec3>& points, const std::vector<int>& component, int n);

struct FlatCounts {
  std::vector<int> removed;  ///< their `face`
  int left = 0;              ///< flat triangles that could not go without opening a crack
};

/// Removes triangles without height, from an oriented manifold, so that the surface stays the same set of
/// points. One whose third vertex lies on its longest edge is a cap: that edge is flipped, so that the
/// neighbour is divided there; on the border the cap is dropped. One with two vertices that nearly coincide
/// is a needle, which collapses into the edge it looks like.
FlatCounts remove_flat(Repair& r, const std::vector<Vec3>& points);

struct HoleCounts {
  int filled = 0, triangles = 0;  ///< loops, and the triangles they took
  int left = 0;                   ///< loops on non-manifold edges, or whose every filling doubles an edge
};

/// Fills border loops of at most `most` edges with triangles between their vertices: of all triangulations
/// the one of least area, the shorter edges deciding between equal ones (cubic in the edges of a loop). The
/// new triangles come last and are copies of the first neighbour of their loop in everything but their
/// corners.
HoleCounts fill_holes(Repair& r, const std::vector<Vec3>& points, int most);

}  // namespace meshpipe
