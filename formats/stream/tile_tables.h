// SPDX-License-Identifier: BSD-3-Clause
// Tiles of a mesh as streams, on which mrelax works as separate jobs.
#pragma once

#include "formats/stream/shards.h"
#include "lib/relax/relax.h"

namespace meshpipe {

/// What the tiles of a mesh have in common.
struct TilesOf {
  int count = 0;
  int vertices = 0;            ///< of the mesh
  std::vector<int> line_kind;  ///< of all lines
  std::vector<int> corners;    ///< vertices of the reference, see relax
  TilePass pass;
  RelaxCounts before;  ///< what passes before this one have done
};

/// A tile, and what it takes to relax it.
struct TileJob {
  int number = 0;
  TilesOf of;
  bool relaxed = false;  ///< has it been done?
  Tile tile;
};

/// Returns whether the stream is a tile: table `tile`.
inline bool is_tile(const Stream& stream) { return stream.find("tile") != nullptr; }

/// Returns the tile as a stream, without history: its mesh is the surface.
Stream stream_of(TileJob job);
/// Takes a tile out of its stream. Throws: BadInput or NotAdmissible for any other stream.
TileJob take_tile(Stream stream);

/// The mesh that relaxed tiles were joined to.
struct JoinedTiles {
  TiledMesh mesh;
  TilesOf of;
  RelaxCounts counts;      ///< of the tiles, and before them
  std::vector<int> seams;  ///< see append_tile
};
/// Joins the tiles from all shards of a stream, whose history is read, with a reference of `faces` triangles.
/// `names`: of the shards' files. Throws: BadInput, with a shard's name, for one that is none of this stream,
/// tiles that are missing, doubled or not relaxed, and shards that were not made by `by`.
JoinedTiles join_tiles(const Stream& whole, int faces, const Provenance& by,
                       const std::vector<std::string>& names, const ReadShard& read);

}  // namespace meshpipe
