// SPDX-License-Identifier: BSD-3-Clause
// Which tables of the stream no longer hold when a program does the work of its stage again.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// What a program has made anew: model edges (mfeature), parts (mpartition, mmultiscale), charts (mparam),
/// the size field (msize), divided lines (mlines).
enum class Stage { features, parts, charts, sizes, lines };

/// Drops the tables that were made from what `remade` stands for: plane meshes always; divided lines but for
/// `lines`; charts for `parts`. Lines that came with a file (without table line_use) stay. Where the mesh has
/// taken the place of its input (table ref_vertex), new parts or charts begin another remeshing: the
/// reference is dropped too, with the vertex columns and the tables that point to it; anything else leaves
/// the tables alone, for they are the reference's. Call it before the new tables are set.
void drop_downstream(Stream& stream, Stage remade);

}  // namespace meshpipe
