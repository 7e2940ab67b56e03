// SPDX-License-Identifier: BSD-3-Clause
// The check of a large result in shards, as separate jobs.
#pragma once
#include <vector>

#include "lib/check/check.h"
#include "tools/shard_files.h"

namespace meshpipe {

/// Measures the shares of the shard that has been read, and writes what was found.
void check_shard(Io& io);

/// Cuts the check of the stream that has been read into shares of at most `tile` triangles.
/// Small results, and those whose vertices are not on the reference's triangles, give no shards.
void cut_into_shards(Io& io, const ShardFiles& shards, int tile, int samples, const Contract& contract);

/// Returns what was measured of the stream's result in shards.
std::vector<ShareFindings> read_checked(const Io& io, const ShardFiles& shards);

}  // namespace meshpipe
