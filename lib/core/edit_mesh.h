// SPDX-License-Identifier: BSD-3-Clause
// A triangle mesh that can be edited in place: flip, split, collapse on flat arrays.
#pragma once
#include <cstdint>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// An oriented manifold with borders. Triangles and vertices removed stay as gaps (tris[t][0] < 0, out[v] <
/// 0). Operations keep every invariant; their preconditions are the caller's to check.
struct EditMesh {
  std::vector<Tri> tris;
  std::vector<int> opp;  ///< opposite half-edge, -1 on the border
  std::vector<std::uint8_t>
      hard;                 ///< per half-edge: must stay an edge (border or model edge); equal on both sides
  std::vector<int> out;     ///< a half-edge leaving each vertex; on the border the one with opp == -1
  std::vector<int> degree;  ///< number of edges at each vertex
  int live = 0;             ///< triangles that are not gaps

  /// Throws like opposite_halfedges.
  EditMesh(std::vector<Tri> triangles, int n_vertices, const std::vector<std::uint8_t>& model);
  /// The same where the neighbors are known.
  explicit EditMesh(const Connectivity& c);

  int from(int h) const { return tris[h / 3][h % 3]; }
  int to(int h) const { return tris[h / 3][(h + 1) % 3]; }
  int apex(int h) const { return tris[h / 3][(h + 2) % 3]; }
  bool dead(int t) const { return tris[t][0] < 0; }
  bool on_border(int v) const { return opp[out[v]] < 0; }

  /// Calls f(h) for every half-edge leaving v within a triangle, counterclockwise.
  template <class F>
  void star(int v, F&& f) const {
    int h = out[v], first = h;
    do {
      f(h);
      h = opp[prev(h)];
    } while (h >= 0 && h != first);
  }
  /// Calls f(w) for every vertex joined to v, counterclockwise.
  template <class F>
  void neighbors(int v, F&& f) const {
    int last = 0;
    star(v, [&](int h) { f(to(h)), last = h; });
    if (opp[prev(last)] < 0) f(apex(last));
  }
  /// Number of edges at v.
  int valence(int v) const { return degree[v]; }
  /// Is there an edge between a and b?
  bool joined(int a, int b) const;

  /// Turns the edge of h within its two triangles: from a-b to c-d. Requires: not hard, c and d not joined.
  void flip(int h);
  /// Puts a new vertex (the next number) on the edge of h, splitting its one or two triangles; the halves of
  /// a hard edge are hard. Triangle n, the next number, is split off triangle h/3, n+1 off triangle opp[h]/3.
  /// Returns the vertex.
  int split(int h);
  /// Contracts the edge of h: one of its vertices (`gone`) becomes the other, and the edge's one or two
  /// triangles go. Requires: can_collapse(h, gone).
  void collapse(int h, int gone);
  /// `gone` has no hard edge, or two of which h is one (it is taken out of its line), and the result is a
  /// manifold of the same topology (link condition). With `merge`, any number of hard edges may meet in
  /// `gone`.
  bool can_collapse(int h, int gone, bool merge = false) const;

 private:
  void start(int n_vertices, const std::vector<std::uint8_t>& model);
};

}  // namespace meshpipe
