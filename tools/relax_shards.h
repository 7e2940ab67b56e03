// SPDX-License-Identifier: BSD-3-Clause
// The tiles of mrelax in shards, as separate jobs.
#pragma once
#include "lib/relax/relax.h"
#include "tools/shard_files.h"

namespace meshpipe {

/// Relaxes the tiles of the shard that has been read, and writes it. `sweeps`: those asked for.
void relax_shard(Io& io, int sweeps);

/// Writes the tiles of the first pass into shards, if the mesh is large enough to have tiles.
void cut_into_shards(Io& io, LiftedMesh mesh, const TiledRelax& relax, const ShardFiles& to);

/// Joins the tiles of shards, and cuts those of the second pass if asked; then `mesh` stays empty, else it is
/// the result. Returns its report. The stream needs no surface.
RelaxReport join_shards(Io& io, LiftedMesh& mesh, const Surface& reference, const RelaxOptions& options,
                        const ShardFiles& shards);

}  // namespace meshpipe
