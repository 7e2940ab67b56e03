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

/// A part of a surface that remembers how it hangs together with the rest.
struct Neighborhood : SurfacePart {
  std::vector<int> opposite;  ///< half-edges; empty if the whole's are not known

  struct Rim {
    int from, to, half_edge;  ///< of the whole
    auto operator<=>(const Rim&) const = default;
  };
  std::vector<Rim> rim{};  ///< sorted; empty if opposite half-edges are not known
};

/// Takes the triangles with labels 0..n-1 (`label`: per triangle, -1: none), each label as one. Opposite
/// half-edges of the whole may be empty. What is to be cut has the face column `origin` (name_origins)
/// before.
std::vector<Neighborhood> take_neighborhoods(const CutSurface& whole, const std::vector<int>& label, int n);

/// Takes the triangles of which at least two corners belong to triangles with label `part`: those of the part
/// and those next to it. `label`, `opposite`: as in take_neighborhoods.
Neighborhood take_neighborhood(const CutSurface& whole, const std::vector<int>& label, int part);

/// Puts a neighborhood back into the surface that it was taken from, after cuts of it (lib/core/cut.h): the
/// result is that of the same cuts of the whole. Appended rows stay in order; opposite half-edges follow.
/// Requires: the part of the whole has not changed, and has the same columns; no edge on the rim was cut.
void put_back(const Neighborhood& part, const CutSurface& whole);

}  // namespace meshpipe
