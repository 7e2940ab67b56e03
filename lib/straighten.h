// SPDX-License-Identifier: BSD-3-Clause
// Straightens the interfaces between the parts of a surface by diffusion and iso-cutting.
#pragma once
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// Moves the interface of each pair of parts (face column `part`, 0..n-1) to the zero level of a diffused
/// indicator of the two sides (threshold dynamics: motion towards shorter curves), pulled straight
/// (lib/level_line.h); where that fails, as on triangles much longer than wide, it is only pulled straight.
/// The two parts' triangles change hands there, all other parts only get split along. Interface edges that
/// are model edges stay. Where the result would not be admissible (part_fault) or longer, the interface of
/// that pair stays as it was. Precondition: parts without fault.
/// `opposite` is the surface's, before and after. With `chosen`, only the interfaces of the parts that it
/// marks.
void straighten_interfaces(Surface& surface, std::vector<int>& opposite, int n_parts, double snap,
                           int max_faces = 0, const std::vector<char>& chosen = {});

}  // namespace meshpipe
