// SPDX-License-Identifier: BSD-3-Clause
// The tiles of mrelax in shards, as separate jobs.
#pragma once
#include <optional>

#include "lib/relax/relax.h"
#include "tools/shard_files.h"

namespace meshpipe {

/// Relaxes the tiles of the shard that has been read, and writes it. `sweeps`: those asked for.
void relax_shard(Io& io, int sweeps);

/// Joins and cuts as asked. Returns the report of the mesh when it is done; none if shards were cut, and the
/// stream is written (of the first pass before). `second_order`: whether the stream had nodes of second
/// order, also before the first pass.
std::optional<RelaxReport> relax_by_shards(Io& io, LiftedMesh& mesh, const TiledRelax& relax,
                                           const ShardFiles& shards, bool& second_order);

}  // namespace meshpipe
