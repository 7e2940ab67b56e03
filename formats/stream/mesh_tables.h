// SPDX-License-Identifier: BSD-3-Clause
// A mesh as two tables of a stream that is not its surface, and back; for formats/stream/ only.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Returns the points as a table of this name with columns x, y, z.
Table point_table(const char* name, const Mesh& mesh);
/// Returns the triangles as a table of this name with columns a, b, c.
Table triangle_table(const char* name, const Mesh& mesh);

Mesh mesh_from(const Table& points, const Table& triangles);

}  // namespace meshpipe
