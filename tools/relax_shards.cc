// SPDX-License-Identifier: BSD-3-Clause
#include "tools/relax_shards.h"

#include <atomic>

#include "formats/stream/lift_tables.h"
#include "formats/stream/tile_tables.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

int tiles_of(const TiledMesh& whole, const RelaxOptions& options) {
  return ((int)whole.mesh.tris.size() + options.tile - 1) / options.tile;
}

/// Writes the tiles into a directory, neighbors in one shard.
void cut(Io& io, const TiledMesh& whole, const TiledRelax& relax, bool repair, const ShardFiles& to) {
  const int tiles = tiles_of(whole, relax.options);
  const TilePass pass = relax.pass(whole, repair);
  ShardWriter shards(io, to, tiles);
  int next = 0;
  relax.cut(whole, pass, [&](Tile tile) {
    Stream stream = stream_of({next++, relax.line_kind, pass, false, std::move(tile)});
    stream.history = io.stream.history;
    shards.add(stream);
  });
  io.say(std::to_string(shards.count()) + (shards.count() == 1 ? " shard of " : " shards of ") +
         std::to_string(tiles) + " tiles, " + std::to_string(whole.mesh.tris.size()) + " triangles");
  io.report["shards"] = shards.count();
  io.report["tiles"] = tiles;
}

}  // namespace

void relax_shard(Io& io, int sweeps) {
  std::atomic<std::size_t> triangles = 0;
  const int n = io.write_each([&](Stream stream) {
    TileJob job = take_tile(std::move(stream));
    if (job.relaxed) throw NotAdmissible("these tiles are relaxed; join them by mrelax --join");
    if (job.pass.sweeps != sweeps)
      throw NotAdmissible("the shards were cut for --sweeps " + std::to_string(job.pass.sweeps));
    relax_tile(job.tile, job.line_kind, job.pass);
    job.relaxed = true;
    triangles += job.tile.mesh.tris.size();
    return stream_of(std::move(job));
  });
  io.say(std::to_string(n) + (n == 1 ? " tile, " : " tiles, ") + std::to_string(triangles) + " triangles");
  io.report["tiles"] = n;
  io.report["triangles"] = triangles.load();
}

std::optional<RelaxReport> relax_by_shards(Io& io, LiftedMesh& mesh, const TiledRelax& relax,
                                           const ShardFiles& shards, bool& second_order) {
  Stream& stream = io.stream;
  BetweenPasses between{{}, second_order};
  const bool optimized = is_between_passes(stream);
  if (optimized && shards.from.empty())
    throw NotAdmissible("the mesh is between two passes over its tiles; expected --join DIR");
  if (!optimized && !uses_tiles(mesh, relax.options)) {
    if (!shards.from.empty()) throw NotAdmissible("the mesh has no tiles; run mrelax without --join");
    io.say(std::to_string(mesh.tris.size()) + " triangles are optimized at once: no shards");
    io.report["shards"] = 0;
    return {};
  }
  TiledMesh whole = optimized ? take_tiled(stream, std::move(mesh), between) : as_tiled(std::move(mesh));
  second_order = between.second_order;
  if (shards.from.empty()) {
    stream.surface = {}, stream.tables.clear();  // frees its memory now
    cut(io, whole, relax, false, shards);
    return {};
  }
  if (optimized && shards.count > 0) throw BadUsage("--shards: this is the last pass");
  stream.surface = {};  // written anew later; frees its memory now
  const TilePass pass = relax.pass(whole, optimized);
  relax.join(whole,
             join_tiles(whole, (int)relax.reference.tris.size(), tiles_of(whole, relax.options), pass,
                        {io.program, "", io.arguments}, shards_in(shards.from), read_shard),
             pass, between.counts);
  if (shards.count > 0) {
    cut(io, whole, relax, true, shards);
    write_tiled(stream, whole, relax.corner, between);
    write_as_it_is(io, stream);
    return {};
  }
  const RelaxReport report = relax.finish(whole, optimized ? 2 : 1, between.counts);
  mesh = std::move(whole.mesh);
  return report;
}

}  // namespace meshpipe
