// SPDX-License-Identifier: BSD-3-Clause
// What a surface has that meshes of good triangles fail on, measured after a failure.
#pragma once
#include <cstddef>

#include "lib/clean/clean.h"

namespace meshpipe {

struct Diagnosis {
  std::size_t intersections = 0;  ///< pairs of triangles that intersect, and do not only touch,
  Vec3 intersection{};            ///< and where the first of them do
  bool open = false;              ///< there are borders: what crosses may have no inside
  double weld = 0;                ///< tolerance that merges points almost at one place; 0: there are none
  std::size_t short_edges = 0;    ///< edges no longer than that,
  double next_edge = 0;           ///< and the shortest of all others
  int spikes = 0;                 ///< for the caller: vertices that stick out, as mclean has found them,
  Gaps gaps;                      ///< borders that almost fit,
  bool joined = false;            ///< whether sheets were left joined where they meet,
  bool sheets = false;            ///< and some of them lie between regions, which a wrap would join
  // Lines of the surface within `reach` of the place of the failure: borders of patches are smooth.
  bool at_border = false, at_patch_border = false, at_crease = false;
};

/// Measures a surface, except what is for the caller. `place` and `reach`: where something failed, and the
/// edge length there; reach 0: unknown. Reads, where present, face columns `patch` and `model`.
Diagnosis diagnose(const Surface& surface, Vec3 place, double reach);

}  // namespace meshpipe
