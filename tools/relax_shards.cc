// SPDX-License-Identifier: BSD-3-Clause
#include "tools/relax_shards.h"

#include "formats/stream/lift_tables.h"
#include "formats/stream/tile_tables.h"
#include "lib/core/error.h"
#include "lib/core/parallel.h"

namespace meshpipe {
namespace {

int tiles_of(const TiledMesh& whole, const RelaxOptions& options) {
  return ((int)whole.mesh.tris.size() + options.tile - 1) / options.tile;
}

/// Writes the tiles into a directory, neighbors in one shard.
void cut(Io& io, const TiledMesh& whole, const TiledRelax& relax, bool repair, const ShardFiles& to) {
  const int tiles = tiles_of(whole, relax.options), count = std::min(to.count, tiles);
  make_directory(to.into);
  const TileWork work{relax.line_kind, relax.pass(whole, repair)};
  int next = 0, shard = 0;
  TileTables some;
  relax.cut(whole, work.pass, [&](const Tile& tile) {
    some.add(next++, tile);
    if (next < (long long)(shard + 1) * tiles / count) return;
    Stream stream;
    stream.history = io.stream.history, stream.remarks = io.stream.remarks;
    stream.ascii = io.stream.ascii;
    some.write(stream, work);
    io.write_to(shard_name(to.into, shard++), stream);
  });
  io.say(std::to_string(count) + (count == 1 ? " shard of " : " shards of ") + std::to_string(tiles) +
         " tiles, " + std::to_string(whole.mesh.tris.size()) + " triangles");
  io.report["shards"] = count;
  io.report["tiles"] = tiles;
}

}  // namespace

void relax_shard(Io& io, int sweeps) {
  TileShard shard = take_tiles(io.stream);
  if (shard.relaxed) throw NotAdmissible("these tiles are relaxed; join them by mrelax --join");
  if (shard.pass.sweeps != sweeps)
    throw NotAdmissible("the shards were cut for --sweeps " + std::to_string(shard.pass.sweeps));
  io.stream.surface = {}, io.stream.tables.clear();  // frees its memory now
  const int n = (int)shard.tiles.size();
  parallel_for(n, [&](int i) { relax_tile(shard.tiles[i], shard.line_kind, shard.pass); });
  shard.relaxed = true;
  std::size_t triangles = 0;
  TileTables done;
  for (int i = 0; i < n; ++i) {
    triangles += shard.tiles[i].mesh.tris.size();
    done.add(shard.numbers[i], shard.tiles[i]);
    shard.tiles[i] = {};  // frees its memory now
  }
  io.say(std::to_string(n) + (n == 1 ? " tile, " : " tiles, ") + std::to_string(triangles) + " triangles");
  io.report["tiles"] = n;
  io.report["triangles"] = triangles;
  done.write(io.stream, shard);
  io.write(io.stream);
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
                        {io.program, "", io.arguments}, shards_in(shards.from),
                        [&](const std::string& name) { return io.read(name); }),
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
