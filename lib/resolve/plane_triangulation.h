// SPDX-License-Identifier: BSD-3-Clause
// A triangulation in a plane that points are added to.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Triangles with half-edges as in lib/core/mesh.h, on points that are numbered elsewhere.
struct PlaneTriangulation {
  std::vector<Tri> tris;
  std::vector<int> opposite;
  std::vector<int> line;  ///< per half-edge: the line it is fixed on, or -1
  std::vector<int> at;    ///< per point: one of its triangles

  int from(int h) const { return origin(tris, h); }
  int to(int h) const { return target(tris, h); }
  int apex(int h) const { return origin(tris, prev(h)); }
  bool fixed(int h) const { return line[h] >= 0; }
  /// Returns a half-edge that starts at point p.
  int leaving(int p) const;
  /// Returns the half-edge from p to q, on the border possibly from q to p; -1 if there is none.
  int half_edge(int p, int q) const;

  void clear();
  int add_triangle();
  void set(int t, const Tri& corners);
  void link(int h, int outer, int on_line);
  void fix(int h, int on_line);
  /// Replaces the edge of h by the other diagonal of its two triangles, which becomes half-edge 3 * (h / 3).
  void flip(int h);
  void split_triangle(int t, int p);
  void split_edge(int h, int p);
};

}  // namespace meshpipe
