// SPDX-License-Identifier: BSD-3-Clause
#include "tools/relax_shards.h"

#include <atomic>

#include "formats/stream/tile_tables.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

/// Writes tiles into a directory, neighbors in one shard.
void cut(Io& io, const TiledMesh& whole, const TiledRelax& relax, TilesOf of, const ShardFiles& to) {
  of.vertices = (int)whole.mesh.points.size();
  of.count = ((int)whole.mesh.tris.size() + relax.options.tile - 1) / relax.options.tile;
  ShardWriter shards(io, to, of.count);
  int next = 0;
  relax.cut(whole, of.pass, [&](Tile tile) {
    Stream stream = stream_of({next++, of, false, std::move(tile)});
    stream.history = io.stream.history;
    shards.add(stream);
  });
  io.say(std::to_string(shards.count()) + (shards.count() == 1 ? " shard of " : " shards of ") +
         std::to_string(of.count) + " tiles, " + std::to_string(whole.mesh.tris.size()) + " triangles");
  io.report["shards"] = shards.count();
  io.report["tiles"] = of.count;
}

}  // namespace

void relax_shard(Io& io, int sweeps) {
  std::atomic<std::size_t> triangles = 0;
  const int n = io.write_each([&](Stream stream) {
    TileJob job = take_tile(std::move(stream));
    if (job.relaxed) throw NotAdmissible("these tiles are relaxed; join them by mrelax --join");
    if (job.of.pass.sweeps != sweeps)
      throw NotAdmissible("the shards were cut for --sweeps " + std::to_string(job.of.pass.sweeps));
    relax_tile(job.tile, job.of.line_kind, job.of.pass);
    job.relaxed = true;
    triangles += job.tile.mesh.tris.size();
    return stream_of(std::move(job));
  });
  io.say(std::to_string(n) + (n == 1 ? " tile, " : " tiles, ") + std::to_string(triangles) + " triangles");
  io.report["tiles"] = n;
  io.report["triangles"] = triangles.load();
}

void cut_into_shards(Io& io, LiftedMesh mesh, const TiledRelax& relax, const ShardFiles& to) {
  if (!uses_tiles(mesh, relax.options)) {
    io.say(std::to_string(mesh.tris.size()) + " triangles are optimized at once: no shards");
    io.report["shards"] = 0;
    return;
  }
  const TiledMesh whole = as_tiled(std::move(mesh));
  TilesOf of{0, 0, relax.line_kind, {}, relax.pass(whole, false), {}};
  for (int v = 0; v < (int)relax.corner.size(); ++v)
    if (relax.corner[v]) of.corners.push_back(v);
  cut(io, whole, relax, std::move(of), to);
}

RelaxReport join_shards(Io& io, LiftedMesh& mesh, const Surface& reference, const RelaxOptions& options,
                        const ShardFiles& shards) {
  JoinedTiles joined = join_tiles(io.stream, (int)reference.tris.size(), {io.program, "", io.arguments},
                                  shards_in(shards.from), read_shard);
  TilesOf& of = joined.of;
  if (of.pass.repair && shards.count > 0) throw BadUsage("--shards: this is the last pass");
  std::vector<char> corner(reference.points.size());
  for (int v : of.corners) {
    if (v < 0 || v >= (int)corner.size())
      throw BadInput(shards.from + ": a corner is vertex " + std::to_string(v) +
                     " of the reference, which has " + std::to_string(corner.size()));
    corner[v] = 1;
  }
  const std::vector<int> line_kind = of.line_kind;
  const TiledRelax relax{reference, line_kind, corner, options};
  relax.relax_seams(joined.mesh, joined.seams, of.pass, joined.counts);
  if (shards.count > 0) {
    of.pass = relax.pass(joined.mesh, true);
    of.before = joined.counts;
    cut(io, joined.mesh, relax, std::move(of), shards);
    return {};
  }
  const RelaxReport report = relax.finish(joined.mesh, of.pass.repair ? 2 : 1, joined.counts);
  mesh = std::move(joined.mesh.mesh);
  return report;
}

}  // namespace meshpipe
