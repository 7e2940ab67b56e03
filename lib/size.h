// SPDX-License-Identifier: BSD-3-Clause
// The size field: target edge length at every vertex.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

/// The edge length at which a mesh of equilateral triangles of this area has n of them.
double size_for_count(double area, double n);

}  // namespace meshpipe
