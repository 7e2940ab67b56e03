// SPDX-License-Identifier: BSD-3-Clause
// Repair of any triangle soup into an oriented manifold, with a report of every repair.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "lib/core/mesh.h"
#include "lib/resolve/resolve.h"
#include "lib/solids/solids.h"

namespace meshpipe {

struct CleanOptions {
  /// Merges vertices this close after the equal ones; 0: only equal ones; negative: those that the precision
  /// of the coordinates does not separate, and clusters and seams, where all other edges are much longer.
  double weld = -1;
  bool drop_nonorientable = false;  ///< leave such components out instead of cutting them open
  bool keep_orientation = false;    ///< reverse no triangle: edges where neighbors disagree are left open
  int keep_components = 0;          ///< the largest by area; 0: all
  int fill_holes = 0;               ///< fill border loops of at most this many edges; 0: none
  bool cap_patches = false;         ///< give each filled hole a patch of its own
  bool keep_flat = false;           ///< leave triangles of zero area, and fill no holes
  bool keep_slits = false;          ///< leave edges that only one side divides
  /// Sheets that meet in edges of more than two triangles: connected in pairs that bound the same solid and
  /// split elsewhere, all split, or left to share their vertices; or paired unless they, or solids within
  /// solids, divide space into regions (lib/solids/solids.h) or pairs leave borders, and else kept.
  enum Sheets { pair, split, keep, automatic } sheets = pair;
  /// Self-intersections: left as they are, resolved into the boundary of the outside, or into all pieces.
  enum Resolve { none, outer, all } resolve = none;
};

/// What may be wrong with a triangle of the input.
enum class Fault { degenerate, duplicate, nonmanifold, pinched, misoriented, nonorientable, small };
constexpr const char* fault_names[] = {
    "degenerate",     "duplicate",      "non-manifold edge", "pinched vertex", "inconsistently oriented",
    "non-orientable", "small component"};
struct OffendingFace {
  int triangle;
  Fault fault;
};

struct HoleCounts {
  int filled = 0, triangles = 0;  ///< loops, and the triangles they took
  int left = 0;                   ///< loops on non-manifold edges, or whose every filling doubles an edge
  std::vector<int> patches;       ///< of the loops filled, if each has its own
  double slit = 0;                ///< the widest slit that is closed where only one side divides an edge
  int slit_vertices = 0;          ///< put on such edges
  int slit_ends = 0;              ///< pairs of vertices merged at the ends of slits
};

/// Where components that are not orientable are cut: both sides are oriented differently there.
struct FlipCounts {
  int triangles = 0, edges = 0;  ///< of these components, and of the lines
  Vec3 place{};                  ///< the middle of the first edge
};

struct SheetCounts {
  bool kept = false;                        ///< sheets share their vertices where they meet
  bool nested = false;                      ///< closed components are within others, and all face outward
  std::vector<std::array<int, 2>> patches;  ///< then: the new patch, and the one it was
  std::vector<std::array<int, 2>> doubles;  ///< triangles of the input: one that stays, one dropped for it
  /// Where solids that touch have different patches: those on both sides of each triangle of the result, 0
  /// where there is one.
  std::vector<std::array<int, 2>> solids;
  FlipCounts flips;
  std::vector<int> border;  ///< half-edges of the result without a neighbor
};

/// Counts of repairs. Triangles are numbered as in the input.
struct CleanReport {
  int input_vertices = 0, input_triangles = 0;
  int welded = 0;        ///< vertices merged with an equal one
  int welded_near = 0;   ///< vertices merged with one within the tolerance
  double tolerance = 0;  ///< of welding: as asked for, else the precision or the largest distance merged
  int unreferenced = 0;  ///< vertices no triangle uses
  int degenerate = 0;    ///< triangles with a repeated vertex, or of zero area: dropped, flipped or collapsed
  int duplicate = 0;     ///< triangles with the same three vertices as an earlier one
  int flipped = 0;       ///< triangles whose orientation was reversed
  int contacts = 0;      ///< triangles where two solids touch, one for each of them
  int nonmanifold_edges = 0;     ///< edges of more than two triangles
  int paired_edges = 0;          ///< those whose triangles are connected in pairs
  int opened_edges = 0;          ///< those that have become borders of sheets
  int nonmanifold_vertices = 0;  ///< vertices of more than one fan (those on such edges included)
  int copies = 0;                ///< vertices added, one for each further fan
  int flat = 0;                  ///< triangles of zero area left in, where dropping them would open a crack
  int components = 0;            ///< of the result
  int dropped_components = 0, dropped_triangles = 0;  ///< by keep_components
  SheetCounts sheets;
  HoleCounts holes;
  ResolveReport resolved;
  std::vector<std::array<int, 2>> nonorientable;  ///< components dropped: first triangle, their number
  std::vector<OffendingFace> offending;           ///< by fault, then by triangle
  bool nothing = false;  ///< nothing was to be repaired, the surface is bit for bit what it was
};

/// Repairs a surface in this order: welds vertices; closes narrow slits (HoleCounts::slit); drops degenerate
/// and duplicate triangles; orients components, or cuts them open where that is impossible; splits
/// non-manifold edges and vertices; removes triangles of zero area; drops small components; fills holes. With
/// `resolve`, resolves self-intersections after that (`outer`: first tried right after welding), then repairs
/// again. A sound surface stays bit for bit the same; a repaired one loses face column `model`; kept sheets
/// share vertices, with a patch each. Throws: NotAdmissible, with the surface unchanged, if its coordinates
/// are too large or small, if no triangle is left (the report has the offending faces), or as resolve does.
void clean(Surface& surface, const CleanOptions& options, CleanReport& report);
CleanReport clean(Surface& surface, const CleanOptions& options = {});

/// Moves each vertex whose neighbors are all farther away than `extents` times the diagonal of the neighbors'
/// bounding box to the mean of its neighbors. Equal vertices count as one. Returns the number moved.
int flatten_spikes(Surface& surface, double extents);

struct Spikes {
  int count = 0;
  Vec3 longest{};  ///< where the longest ends
  /// Returns the count of a remark of the stream, "spikes COUNT"; 0 for other texts.
  static int parse(const std::string& remark);
};
/// Finds the vertices of a welded surface whose neighbors are all farther away than 5 diagonals of the
/// neighbors' bounding box; none if they are more than 0.1 % of the vertices.
Spikes find_spikes(const Surface& surface);

/// Borders that would fit others if their points were not off by up to an eighth of an edge.
struct Gaps {
  int closed = 0, edges = 0;  ///< border edges that would have a partner, and all
  double within = 0;          ///< CleanOptions::weld that closes them
  /// Returns the finding as a clause of a message. A remark of the stream has it after "gaps ".
  std::string text() const;
};
/// Returns what the last such remark says; all 0 if there is none.
Gaps gaps_of(const std::vector<std::string>& remarks);
/// Finds such borders if they are at least half of all, and welding them merges no ends of edges; else all
/// is 0. `surface`: as clean returns it, with this report.
Gaps find_gaps(const Surface& surface, const CleanReport& report);

/// Copies vertices so that sheets and fans no longer share them: an oriented manifold of the same triangles.
/// Throws: NotAdmissible if the surface needs any other repair.
void split_sheets(Surface& surface);

/// The regions of a surface whose sheets were kept.
struct RegionReport {
  std::vector<SheetPatch> sheets;
  std::vector<int> label;                 ///< per region; the first is the outside
  std::vector<double> volume;             ///< per region
  std::vector<std::array<int, 2>> added;  ///< patches: the new one, and the one it was
  int reversed = 0;                       ///< sheets that had the outside behind them
  int free_edges = 0;                     ///< of one triangle: a sheet ends there
  Vec3 free_at{};                         ///< middle of the first
};

/// Takes kept sheets apart: copies of vertices, with the same coordinates, make them a manifold with borders
/// where they meet; edges at which a sheet would close again are divided. Gives each patch one region on
/// either side, and orients sheets next to the outside towards it; there are no regions if sheets only flip.
/// `given`: labels per triangle as in labels_of; empty: 1, 2 ... Throws: as labels_of and split_sheets.
RegionReport take_apart(Surface& surface, std::vector<std::array<int, 2>> given = {});

/// A row of the table of repairs: its key in reports, the number of cases, and a phrase.
struct RepairRow {
  const char* key;
  int count;
  std::string what;
};
/// Returns the rows of the table of repairs, those with count 0 too.
std::vector<RepairRow> table_of(const CleanReport& report, const CleanOptions& options);

/// Returns the remark for the stream on what the result's topology does not show: "clean opened EDGES split
/// VERTICES dropped TRIANGLES"; "" if all are 0.
std::string remark_of(const CleanReport& report);
/// What a remark says; all 0 of other texts.
struct Remark {
  int opened = 0, split = 0, dropped = 0;
};
/// Returns the counts of such a remark; all 0 for other texts.
Remark parse_remark(const std::string& text);

/// Returns a triangle of the input for each fault (report.offending), some several times. Face column `patch`
/// is the fault, counted from 1 as in fault_names; `origin` is the triangle's row in the input.
Surface offending_faces(const CleanReport& report, const Mesh& input);

}  // namespace meshpipe
