// SPDX-License-Identifier: BSD-3-Clause
// Faults of a mesh's connectivity, and the topology of a mesh without any.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Faults of a mesh, one triangle for each, in an order that depends on the mesh only; and its counts.
struct Soundness {
  int vertices = 0, edges = 0, faces = 0;  ///< vertices that are used
  std::vector<int> degenerate;             ///< triangles with a repeated vertex
  std::vector<int> nonmanifold;            ///< edges of more than two triangles
  std::vector<int> misoriented;            ///< edges along which two triangles are inconsistently oriented
  std::vector<int> pinched;                ///< vertices whose triangles form more than one fan
  bool sound() const {
    return degenerate.empty() && nonmanifold.empty() && misoriented.empty() && pinched.empty();
  }
  std::vector<int> opposite;  ///< as in lib/core/mesh.h; -1 along faulty edges, too
  // of a sound mesh only:
  int components = 0, genus = 0, loops = 0;
  int loop = -1;             ///< a half-edge of the shortest border loop
  int small_component = -1;  ///< a triangle of the smallest component
};

/// Examines any triangles; never throws. Requires: corners are rows of `points`.
Soundness soundness_of(const Mesh& mesh);

}  // namespace meshpipe
