// SPDX-License-Identifier: BSD-3-Clause
// Makes any triangle soup an oriented manifold, and tells every repair.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

struct CleanOptions {
  double weld = 0;                  ///< merge vertices this close after the equal ones; 0: only equal ones
  bool drop_nonorientable = false;  ///< leave such components out instead of refusing the surface
  int keep_components = 0;          ///< the largest by area; 0: all
  int fill_holes = 0;               ///< fill border loops of at most this many edges; 0: none
  bool keep_sheets = false;         ///< sheets go on sharing the vertices where they meet
};

/// What may be wrong with a triangle of the input.
enum class Fault { degenerate, duplicate, nonmanifold, pinched, turned, nonorientable, small };
constexpr const char* fault_names[] = {"degenerate",     "duplicate",    "non-manifold edge",
                                       "pinched vertex", "turned round", "non-orientable",
                                       "small component"};
struct Culprit {
  int triangle;
  Fault fault;
};

/// A component that is not orientable.
struct Nonorientable {
  int triangle = 0, triangles = 0;  ///< its first triangle, and how many it has
  int a = 0, b = 0;                 ///< two neighbours that cannot agree
  Vec3 place;                       ///< middle of the edge between them
};

/// Triangles are numbered as in the input.
struct CleanReport {
  int input_vertices = 0, input_triangles = 0;
  int welded = 0;        ///< vertices merged with an equal one
  int welded_near = 0;   ///< vertices merged with one within the tolerance
  int unreferenced = 0;  ///< vertices no triangle uses
  int degenerate = 0;    ///< triangles with a repeated vertex, or of zero area: dropped, flipped or collapsed
  int duplicate = 0;     ///< triangles with the same three vertices as an earlier one
  int flipped = 0;       ///< triangles turned round
  int nonmanifold_edges = 0;  ///< edges of more than two triangles, split into sheets
  int nonmanifold_vertices =
      0;               ///< vertices of more than one fan (those on such edges included), one copy a fan
  int copies = 0;      ///< vertices more than before the split
  int flat = 0;        ///< triangles of zero area left in, where dropping them would open a crack
  int components = 0;  ///< of the result
  int dropped_components = 0, dropped_triangles = 0;  ///< by keep_components
  int holes_filled = 0, hole_triangles = 0, holes_left = 0;
  std::vector<std::array<int, 2>> sheet_patches;  ///< by keep_sheets: the new patch, and the one it was
  std::vector<Nonorientable> nonorientable;       ///< components dropped
  std::vector<Culprit> culprits;                  ///< by fault, then by triangle
  bool nothing = false;  ///< nothing was to be repaired, the surface is bit for bit what it was
};

/// One line: which component, how large, which triangles, where.
std::string describe(const Nonorientable& component);

/// One line: of how many triangles none is left, and why.
std::string describe_nothing_left(const CleanReport& report);

/// A row of the table of what was done: its key in reports, how often, and in words.
struct RepairRow {
  const char* key;
  int count;
  std::string what;
};
std::vector<RepairRow> table_of(const CleanReport& report, const CleanOptions& options);

/// The culprits as a mesh on the input's points: a triangle for each fault that one has. Face column `patch`
/// is the fault, counted from 1 as in fault_names; `origin` is the triangle's number in the input.
Surface surface_of_culprits(const CleanReport& report, const Mesh& input);

/// Welds vertices of equal coordinates (then those within `weld`), drops degenerate and duplicate triangles,
/// orients every component (by majority; a closed one outward), splits non-manifold edges and pinched
/// vertices, removes triangles of zero area, drops small components and fills holes if asked to. Face columns
/// follow their triangles; vertex columns those of the first vertex welded. Vertices are renumbered by first
/// use if some had to go; copies come last otherwise. A surface that needs none of it is left bit for bit as
/// it is, copies of vertices that keep fans apart included; one that does loses the face column `model`.
/// With keep_sheets the copies are undone at the end: edges of more than two triangles stay, marked in face
/// column `model`, as borders of sheets; a patch that has triangles on several of the sheets that meet in
/// such edges becomes one patch a sheet, numbered after the others (`sheet_patches`). Throws NotAdmissible
/// naming triangles and place if a component is not orientable, or if no triangle is left; the report then
/// holds the culprits, and the surface is as it was.
void clean(Surface& surface, const CleanOptions& options, CleanReport& report);
CleanReport clean(Surface& surface, const CleanOptions& options = {});

/// The same triangles with copies of vertices that keep sheets and fans apart: an oriented manifold. Throws
/// NotAdmissible if more than copies are missing to that.
Mesh sheets_apart(const Mesh& mesh);

}  // namespace meshpipe
