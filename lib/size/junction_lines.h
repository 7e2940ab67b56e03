// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Lowers the sizes along short lines where more than two triangles meet, between the points where such lines
/// meet or end: the triangles around the only segment of such a line can be no better than its length allows.
/// `size` is per vertex.
void lower_along_short_lines(const Mesh& mesh, std::vector<double>& size);

}  // namespace meshpipe
