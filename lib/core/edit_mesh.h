// SPDX-License-Identifier: BSD-3-Clause
// A triangle mesh that can be edited in place: flip, split, collapse on flat arrays.
#pragma once
#include <cstdint>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// An oriented manifold with borders. Triangles and vertices that are removed stay as gaps (tris[t][0] < 0,
/// out[v] < 0). Operations keep every invariant if their preconditions, which the caller checks, hold.
struct EditMesh {
  std::vector<Tri> tris;
  std::vector<int> opp;  ///< opposite half-edge, -1 on the border
  std::vector<std::uint8_t>
      hard;                 ///< per half-edge: must stay an edge (border or model edge); equal on both sides
  std::vector<int> out;     ///< a half-edge leaving each vertex; on the border the one with opp == -1
  std::vector<int> degree;  ///< number of edges at each vertex
  int live = 0;             ///< triangles that are not gaps

  /// Takes triangles and the bits of their model edges (empty: none). Throws: as opposite_halfedges.
  EditMesh(std::vector<Tri> triangles, int n_vertices, const std::vector<std::uint8_t>& model);
  /// Copies a mesh whose opposite half-edges are known.
  explicit EditMesh(const Connectivity& c);

  int from(int h) const { return tris[h / 3][h % 3]; }
  int to(int h) const { return tris[h / 3][(h + 1) % 3]; }
  int apex(int h) const { return tris[h / 3][(h + 2) % 3]; }
  bool dead(int t) const { return tris[t][0] < 0; }
  bool on_border(int v) const { return opp[out[v]] < 0; }

  /// Calls f(h) for every half-edge that leaves v, counterclockwise.
  template <class F>
  void star(int v, F&& f) const {
    int h = out[v], first = h;
    do {
      f(h);
      h = opp[prev(h)];
    } while (h >= 0 && h != first);
  }
  /// Calls f(w) for every vertex joined to v by an edge, counterclockwise.
  template <class F>
  void neighbors(int v, F&& f) const {
    int last = 0;
    star(v, [&](int h) { f(to(h)), last = h; });
    if (opp[prev(last)] < 0) f(apex(last));
  }
  /// Returns the number of edges at v.
  int valence(int v) const { return degree[v]; }
  /// Returns whether an edge joins a and b.
  bool joined(int a, int b) const;

  /// Replaces the edge of h by the other diagonal of its two triangles. Requires: the edge is not hard, and
  /// no edge joins the new ends.
  void flip(int h);
  /// Puts a new vertex on the edge of h and splits its one or two triangles; the halves of a hard edge are
  /// hard. Triangle n, the next number, is split off h/3, and n+1 off opp[h]/3. Returns the vertex, the last.
  int split(int h);
  /// Contracts the edge of h: its vertex `gone` becomes the other one, and the edge's one or two triangles
  /// go. Requires: can_collapse(h, gone).
  void collapse(int h, int gone);
  /// Returns whether `gone` may be merged into the other vertex of h: it has no hard edge, or two and h is
  /// one of them (with `merge`, any number); if on the border, h is, too; it has 3 (with `merge`, on the
  /// border 2) to 64 edges; and the result is a manifold of the same topology (link condition).
  bool can_collapse(int h, int gone, bool merge = false) const;

 private:
  void start(int n_vertices, const std::vector<std::uint8_t>& model);
};

}  // namespace meshpipe
