// SPDX-License-Identifier: BSD-3-Clause
// The tiles of mrelax in shards, as jobs of their own.
#pragma once
#include <optional>
#include <string>

#include "lib/relax/relax.h"
#include "tools/io.h"

namespace meshpipe {

/// Where shards go, and where those come from that are to be joined.
struct RelaxShards {
  int count = 0;
  std::string into, from;
};

/// Relaxes the tiles of the shard that has been read, and writes it. `sweeps`: those asked for.
void relax_shard(Io& io, int sweeps);

/// Joins and cuts as asked. Returns the report of the mesh when it is done; none if shards were cut, and the
/// stream is written. `second_order`: whether the stream had nodes of second order, also before the first
/// pass.
std::optional<RelaxReport> relax_by_shards(Io& io, LiftedMesh& mesh, const TiledRelax& relax,
                                           const RelaxShards& shards, bool& second_order);

}  // namespace meshpipe
