// SPDX-License-Identifier: BSD-3-Clause
// Grids of triangles for the tests of maps, and what they are measured by.
#pragma once
#include "lib/core/topology.h"
#include "lib/param/injective.h"
#include "lib/param/param.h"

namespace meshpipe {

/// (i, j) -> (s, t) in the unit square -> space, in n x m quadrilaterals with `keep` deciding which are
/// there; the columns s = 0 and s = 1 are one if `closed`. Diagonals alternate.
template <class Place, class Keep>
SubMesh grid(int n, int m, bool closed, Place place, Keep keep) {
  Mesh mesh;
  int columns = closed ? n : n + 1;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < columns; ++i) mesh.points.push_back(place((double)i / n, (double)j / m));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      if (!keep(i, j)) continue;
      int a = j * columns + i, b = j * columns + (i + 1) % columns, c = b + columns, d = a + columns;
      if ((i + j) % 2) {
        mesh.tris.push_back({a, b, c});
        mesh.tris.push_back({a, c, d});
      } else {
        mesh.tris.push_back({a, b, d});
        mesh.tris.push_back({b, c, d});
      }
    }
  return split_by_label(mesh, std::vector<int>(mesh.tris.size(), 0), 1)[0];
}
inline bool all(int, int) { return true; }

inline bool one_to_one(const SubMesh& m, const std::vector<Vec2>& uv) {
  return count_inverted(m.tris, uv) == 0 &&
         border_is_simple({m, opposite_halfedges(m.tris, (int)m.points.size())}, uv);
}
inline ParamReport distortion(const SubMesh& m, const std::vector<Vec2>& uv) {
  ParamReport r;
  measure_distortion(m, uv, r);
  return r;
}

}  // namespace meshpipe
