// SPDX-License-Identifier: BSD-3-Clause
// A part of a surface with the triangles around it, to be cut without touching the rest.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Triangles of a surface as a surface of their own, with all columns; vertices keep their order.
struct SurfacePart {
  Surface surface;
  std::vector<int> face, vertex;  ///< in the whole
};
SurfacePart take_faces(const Surface& whole, std::vector<int> faces);

/// The triangles of a part and those with two of its vertices.
struct Neighborhood : SurfacePart {
  std::vector<int> opposite;  ///< half-edges; empty if the whole's are not known

  struct Rim {
    int from, to, half_edge;  ///< of the whole
    auto operator<=>(const Rim&) const = default;
  };
  std::vector<Rim> rim{};  ///< sorted
};

/// Takes the triangles of which at least `corners` corners (1 to 3) belong to triangles with label `part`
/// (`label`: per triangle). Opposite half-edges of the whole may be empty.
Neighborhood take_neighborhood(const CutSurface& whole, const std::vector<int>& label, int part,
                               int corners = 2);

/// Puts a neighborhood back into the surface that it was taken from, after cuts of it (lib/core/cut.h): the
/// result is that of the same cuts of the whole. Appended rows stay in order; opposite half-edges follow.
/// Requires: the whole has not changed and has the same columns; no edge on the rim was cut.
void put_back(const Neighborhood& part, const CutSurface& whole);

}  // namespace meshpipe
