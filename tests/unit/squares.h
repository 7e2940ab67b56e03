// SPDX-License-Identifier: BSD-3-Clause
// A flat mesh that several tests cut.
#pragma once
#include "lib/core/mesh.h"

namespace meshpipe {

//  d---c
//  | / |   n x n unit squares of two triangles abc and acd, by rows, from the origin in the plane z = 0
//  a---b
inline Mesh unit_squares(int n) {
  Mesh m;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) m.points.push_back({(double)x, (double)y, 0});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x, b = a + 1, c = b + n + 1, d = a + n + 1;
      m.tris.push_back({a, b, c});
      m.tris.push_back({a, c, d});
    }
  return m;
}

}  // namespace meshpipe
