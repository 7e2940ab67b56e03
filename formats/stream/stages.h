// SPDX-License-Identifier: BSD-3-Clause
// Which tables of the stream become invalid when a stage runs again.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// What a stage made again: model edges (mfeature), parts (mpartition, mmultiscale), charts (mparam), the
/// size field (msize), divided lines (mlines).
enum class Stage { features, parts, charts, sizes, lines };

/// Drops the tables that depend on what is made again: plane meshes always; divided lines except for `lines`,
/// but not lines of a file (without table line_use); charts for `parts`. In a lifted stream (table
/// ref_vertex) new parts or charts begin another remeshing and drop the reference with all that refers to it;
/// anything else drops nothing. New model edges drop the surface before it was coarsened. To be called before
/// the new tables are set.
void drop_downstream(Stream& stream, Stage remade);

}  // namespace meshpipe
