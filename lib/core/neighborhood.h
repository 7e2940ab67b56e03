// SPDX-License-Identifier: BSD-3-Clause
// A part of a surface with the triangles around it, to be cut without touching the rest.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Triangles of a surface and their vertices, in their order, as a surface of their own with all columns.
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

/// Takes the neighborhood of the triangles with this label (per triangle): all with as many corners that
/// these have. Opposite half-edges may be empty.
Neighborhood take_neighborhood(const CutSurface& whole, const std::vector<int>& label, int part,
                               int corners = 2);

/// Puts a neighborhood back into the surface that it was taken from, as cuts (lib/core/cut.h) have left it:
/// what they appended is appended in the same order, and opposite half-edges follow. The result is that of
/// the same cut of the whole. Requires: columns as in the whole; edges on its rim not cut.
void put_back(const Neighborhood& part, const CutSurface& whole);

}  // namespace meshpipe
