// SPDX-License-Identifier: BSD-3-Clause
// One vertex for all at the same place.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

/// Makes one vertex of all that have the same coordinates, and drops those that no triangle uses; vertices
/// are numbered by first use. Triangles stay as they are otherwise.
void weld(Mesh& mesh);

}  // namespace meshpipe
