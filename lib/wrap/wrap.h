// SPDX-License-Identifier: BSD-3-Clause
// A closed surface around any triangle soup, at a distance.
#pragma once
#include <cstdint>

#include "lib/core/mesh.h"

namespace meshpipe {

struct WrapOptions {
  double alpha = 0;   ///< length: the wrap enters no hole, slot or cavity narrower than this
  double offset = 0;  ///< length: distance of the wrap from the soup
  std::int64_t most_bytes = std::int64_t{4} << 30;  ///< memory that the grid and the wrap may take
};

struct WrapReport {
  double spacing = 0;      ///< of the grid, a length: about the length of the wrap's edges
  std::int64_t bytes = 0;  ///< predicted memory
  int components = 0;      ///< of the wrap
  int genus = 0;           ///< summed over the components
  int held = 0;            ///< vertices kept farther out, where the fitted surface met the soup or itself
  double clearance = 0;    ///< smallest distance of a vertex of the wrap from the soup
  double farthest = 0;     ///< bound on the distance of any point of the wrap from the soup
  double farthest_allowed = 0;  ///< of that bound: offset, half of alpha, and 1.5 spacings
};

/// Wraps the soup: returns a closed, outward oriented manifold without self-intersections that holds every
/// triangle of the soup strictly inside; the same at any number of threads. Requires: positive, finite alpha
/// and offset.
/// Throws: NotAdmissible if there is no triangle (segments and points count as triangles); BadUsage if the
/// grid takes more than `most_bytes`, naming both and an alpha to try; ContractMissed if the result does not
/// pass verify_wrap.
/// Source: dual contouring (Ju and others 2002) of a well-composed voxel set (Latecki 1997), closed by a
/// rolling ball.
Mesh wrap(const Mesh& soup, const WrapOptions& options, WrapReport& report);

/// Checks every promise of `wrap`, intersections by exact predicates, and sets components, genus, clearance
/// and farthest in the report, of which it reads spacing and farthest_allowed. Throws: ContractMissed naming
/// the first promise broken.
void verify_wrap(const Mesh& wrap, const Mesh& soup, WrapReport& report);

}  // namespace meshpipe
