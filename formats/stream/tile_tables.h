// SPDX-License-Identifier: BSD-3-Clause
// Tiles of a mesh as streams, on which mrelax works as jobs of their own, and the mesh between two passes.
#pragma once
#include <array>

#include "formats/stream.h"
#include "lib/relax/relax.h"

namespace meshpipe {

/// What it takes to relax some tiles of a mesh.
struct TileWork {
  std::vector<int> line_kind;  ///< of all lines of the whole
  TilePass pass;
  bool relaxed = false;  ///< has it been done?
};
struct TileShard : TileWork {
  std::vector<int> numbers;  ///< of the tiles in the whole, ascending
  std::vector<Tile> tiles;   ///< without `triangles`
};

/// Returns whether the stream has tiles, table `tile`.
inline bool has_tiles(const Stream& stream) { return stream.find("tile") != nullptr; }

/// Tiles one after the other as the columns of a stream.
class TileTables {
 public:
  void add(int number, const Tile& tile);
  /// Moves the tiles into a stream, from which all tables are dropped: their meshes are its surface.
  void write(Stream& stream, const TileWork& work);

 private:
  std::vector<int> numbers_;
  std::vector<std::array<int, 7>> rows_;  ///< of each tile in the tables, see `sizes` in tile_tables.cc
  std::vector<RelaxCounts> counts_;
  TiledMesh all_;
  std::vector<int> vertices_, excess_, faces_;
  std::vector<char> corner_;
  Mesh others_;
  Surface slice_;
  std::vector<int> rim_[2];
};

/// Takes what TileTables wrote out of the stream. Throws: BadInput if the rows of a table are not those of
/// the tiles.
TileShard take_tiles(Stream& stream);

/// Returns the tiles from all shards in their order, relaxed. `read` returns a shard by its name.
/// Throws: BadInput, with a shard's name, for one that is none of this mesh and pass, tiles that are missing,
/// doubled or not relaxed, and shards that were not made by `by`.
std::vector<Tile> join_tiles(const TiledMesh& whole, int reference_faces, int tiles, const TilePass& pass,
                             const Provenance& by, const std::vector<std::string>& names,
                             const std::function<Stream(const std::string&)>& read);

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
