// SPDX-License-Identifier: BSD-3-Clause
// Optimization of a mesh on its reference surface, across every interface that is not a model edge.
#pragma once
#include <functional>
#include <utility>

#include "lib/lift/lift.h"
#include "lib/solids/solids.h"

namespace meshpipe {

struct RelaxOptions {
  int sweeps = 4;
  /// Triangle count of the result; refinement in narrow places is taken from the rest. 0: as the size field
  /// asks, and narrow places have more.
  double target_triangles = 0;
  bool keep_count = false;   ///< repair of shapes adds few triangles, except where kappa is below 0.25
  bool keep_border = false;  ///< no new vertex on the border
  bool sheets_meet = false;  ///< border vertices at the same place, to the last bit, are copies of one
  /// Meshes of more than four times this number of triangles are optimized in tiles of at most as many, in
  /// parallel. With 250,000 a tile takes about 75 MB, and the seams are 7 % of all.
  int tile = 250000;
  /// The regions on both sides of each patch. Vertices inside of sheets are moved off the reference, by at
  /// most 0.08 of their shortest edge, to bring the volumes near to those of the reference.
  std::vector<SheetPatch> sheets;
};

struct RelaxCounts {
  int splits = 0, collapses = 0, flips = 0, moves = 0;
  int corners_merged = 0;  ///< corners of the model merged with one much nearer than the size
  int tries = 1;           ///< optimizations that it took to meet the target count, at most 3
};

struct RelaxReport : RelaxCounts {
  /// Pairs of triangles of the result that intersect where the reference does not, sorted.
  std::vector<std::pair<int, int>> intersections;
  int intersections_of_reference = 0;  ///< pairs of the result that intersect where the reference does, too
  double kappa_min = 0, kappa_mean = 0;
  int restarts = 0;         ///< optimizations with sizes reduced where faults were left
  double volume_error = 0;  ///< of regions between sheets: the largest relative difference of a volume
};

/// Flips, collapses, splits and moves until the mesh is regular, judged in space. Vertices stay on the
/// reference; borders, model edges and corners stay; vertices of interface lines (line_kind[line] ==
/// interface_line) are free.
/// reference: read are vertex column `size` (else the mesh's own sizes), face columns `model` and `origin`
/// corner: per vertex of the reference, 1 where a line has a corner that stays, unless another is much nearer
/// than the size; empty: only ends and junctions of lines stay
/// Returns the same bytes at any number of threads.
RelaxReport relax(LiftedMesh& mesh, const Surface& reference, const std::vector<int>& line_kind,
                  const std::vector<char>& corner = {}, const RelaxOptions& options = {});

/// How a vertex may move; one of `fixed` or later does not move.
enum Hold : char {
  loose,
  slides,    ///< along a border or model edge
  fixed,     ///< a corner
  anchored,  ///< at a feature that the mesh would miss
  frozen,    ///< at the rim of a patch or tile
  paired     ///< on an open seam
};

/// A mesh with what its vertices remember from one pass over its tiles to the next.
struct TiledMesh {
  LiftedMesh mesh;
  std::vector<Hold> hold;          ///< anchored, fixed or paired; loose: as the lines hold it
  std::vector<double> refinement;  ///< factor on the size, below 1 where triangles intersected
};

/// The vertices of a tile that other tiles have, too, as they are in the whole mesh; no triangles.
struct Rim : TiledMesh {
  std::vector<int> vertex, row;  ///< their rows in the tile and in the whole
  std::vector<int> excess;       ///< in the whole: see excess
};

/// Triangles of a mesh as a mesh of its own, whose rim is frozen, with the part of the reference below it.
struct Tile : TiledMesh {
  Rim rim;
  std::vector<std::pair<int, int>> model_rim;  ///< model edges between vertices of the rim, rows of the whole
  Mesh others;                                 ///< triangles of the whole around it
  Surface slice;                               ///< of the reference
  std::vector<int> faces;                      ///< its rows in the reference
  std::vector<char> corner;  ///< per vertex of the slice, see relax; empty if none are known
  RelaxCounts counts;        ///< of what was done to it
};

/// The parameters of a pass over the tiles of a mesh, which optimizes them or, the second, repairs them.
struct TilePass {
  int sweeps = 4;
  bool keep_border = false;
  bool repair = false;
  bool to_count = false;  ///< is the goal what was asked for?
  bool keep_count = false;
  double goal = 1;         ///< triangles to come to, per triangle
  double sample_size = 0;  ///< distance of the samples of features
  double mean_size = 0;    ///< of the mesh
  double share = 1;        ///< of the work that is shown, per tile
};

/// The optimization of a large mesh in steps, whose tiles may be separate jobs. For a mesh for which
/// `uses_tiles`, `relax` does the same, to the bit. Arguments as in relax.
struct TiledRelax {
  const Surface& reference;
  const std::vector<int>& line_kind;
  const std::vector<char>& corner;
  const RelaxOptions& options;

  /// Returns the parameters of the first pass, or with `repair` of the second.
  TilePass pass(const TiledMesh& whole, bool repair) const;
  /// Cuts the mesh into tiles and calls `take` for each, in their order.
  void cut(const TiledMesh& whole, const TilePass& pass, const std::function<void(Tile)>& take) const;
  /// Makes a pass over the seams between joined tiles: around these vertices. Adds to `counts`.
  void relax_seams(TiledMesh& whole, const std::vector<int>& seams, const TilePass& pass,
                   RelaxCounts& counts) const;
  /// Makes the passes left of two after `passes`, and repairs where tiles intersect. `counts`: done before.
  RelaxReport finish(TiledMesh& whole, int passes, const RelaxCounts& counts) const;
};
/// Returns whether relax works in tiles: whether the mesh has more than four times options.tile triangles.
bool uses_tiles(const LiftedMesh& mesh, const RelaxOptions& options);
/// Makes a mesh ready for its first pass.
TiledMesh as_tiled(LiftedMesh mesh);
/// Optimizes or repairs a tile. Its places are then rows of the whole reference, and its slice is empty.
void relax_tile(Tile& tile, const std::vector<int>& line_kind, const TilePass& pass);
/// Adds the numbers of operations to a sum.
void add(RelaxCounts& sum, const RelaxCounts& counts);

/// Removes the triangles of `region` (rows) from a mesh, and the vertices that no others have. Returns the
/// new row of each vertex, or -1.
std::vector<int> remove_region(TiledMesh& whole, const std::vector<int>& region);
/// Reserves memory for these numbers of points and triangles in all.
void reserve(TiledMesh& whole, std::size_t points, std::size_t triangles);
/// Appends a relaxed tile to `whole`. `number`, updated: per vertex of the mesh from which the tile was cut,
/// its row in `whole`, -1: none yet. `seams` receives the rows that are added for the tile's rim, which was
/// frozen only because other tiles have it. Throws: BadInput if the rim is not, to the last bit, that of
/// other tiles.
void append_tile(TiledMesh& whole, const Tile& tile, std::vector<int>& number, std::vector<int>& seams);

}  // namespace meshpipe
