// SPDX-License-Identifier: BSD-3-Clause
// Tiles of a mesh as streams, on which mrelax works as separate jobs, and the mesh between two passes.
#pragma once

#include "formats/stream/shards.h"
#include "lib/relax/relax.h"

namespace meshpipe {

/// A tile, and what it takes to relax it.
struct TileJob {
  int number = 0;              ///< of the tile in the whole
  std::vector<int> line_kind;  ///< of all lines of the whole
  TilePass pass;
  bool relaxed = false;  ///< has it been done?
  Tile tile;             ///< without `triangles`
};

/// Returns whether the stream is a tile: table `tile`.
inline bool is_tile(const Stream& stream) { return stream.find("tile") != nullptr; }

/// The tile as a stream, without history: its mesh is the surface.
Stream stream_of(TileJob job);
/// Takes a tile out of its stream. Throws: BadInput, NotAdmissible for another one.
TileJob take_tile(Stream stream);

/// Returns the tiles from all shards in their order, relaxed.
/// Throws: BadInput, with a shard's name, for one that is none of this mesh and pass, tiles that are missing,
/// doubled or not relaxed, and shards that were not made by `by`.
std::vector<Tile> join_tiles(const TiledMesh& whole, int reference_faces, int tiles, const TilePass& pass,
                             const Provenance& by, const std::vector<std::string>& names,
                             const ReadShard& read);

/// What a stream knows of its mesh between two passes.
struct BetweenPasses {
  RelaxCounts counts;
  bool second_order = false;
};
/// Returns whether the stream is between two passes: table `relaxing`.
inline bool is_between_passes(const Stream& stream) { return stream.find("relaxing") != nullptr; }
/// Requires write_reference before. `corner`: see relax.
void write_tiled(Stream& stream, const TiledMesh& mesh, const std::vector<char>& corner,
                 const BetweenPasses& between);
/// Returns the mesh that has been read from the stream with what it remembers, and forgets the table.
TiledMesh take_tiled(Stream& stream, LiftedMesh mesh, BetweenPasses& between);
/// Returns the corners of such a stream's reference.
std::vector<char> read_corners(const Stream& stream);

}  // namespace meshpipe
