// SPDX-License-Identifier: BSD-3-Clause
// A slender cone, open below, for tests of what is done at its peak.
#pragma once
#include <cmath>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Of height 10 and radius `radius`, with the peak (vertex 0) up: `rows` rings of `around` vertices.
inline Mesh spire(double radius, int rows, int around) {
  Mesh m{{{0, 0, 10}}, {}};
  auto vertex = [&](int row, int i) { return 1 + row * around + i % around; };
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < around; ++i) {
      const double down = (row + 1.0) / rows, angle = 2 * 3.14159265358979 * i / around;
      m.points.push_back({radius * down * std::cos(angle), radius * down * std::sin(angle), 10 - 10 * down});
      if (row == 0) {
        m.tris.push_back({0, vertex(0, i), vertex(0, i + 1)});
        continue;
      }
      m.tris.push_back({vertex(row - 1, i), vertex(row, i), vertex(row, i + 1)});
      m.tris.push_back({vertex(row - 1, i), vertex(row, i + 1), vertex(row - 1, i + 1)});
    }
  return m;
}

}  // namespace meshpipe
