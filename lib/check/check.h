// SPDX-License-Identifier: BSD-3-Clause
// Verification of a result against the surface it was made from: findings, figures, contract, offending
// faces.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/check/diagnosis.h"
#include "lib/check/distance.h"
#include "lib/check/needles.h"
#include "lib/check/patches.h"
#include "lib/check/quality.h"
#include "lib/check/shares.h"
#include "lib/check/sheets.h"
#include "lib/check/soundness.h"
#include "lib/lines/lines.h"

namespace meshpipe {

/// Half-edges of the result, one for each edge at fault.
struct FaultyEdges {
  std::vector<int> folds;             ///< see find_folds
  std::vector<int> cut_creases;       ///< see find_cut_creases
  std::vector<int> unmarked_borders;  ///< no model edges, where the reference's patches end at model edges
};

/// Pairs of the reference's triangles that intersect, counted when the mesh has some, or sheets meet.
struct ReferencePairs {
  int all = -1;      ///< -1: not counted
  int crossing = 0;  ///< those that do not only touch
  int apart = 0;     ///< those without a corner in the same place
};

struct Findings {
  Soundness mesh, reference;
  Quality quality, reference_quality;
  Distance distance;
  double boundary = 0;  ///< Hausdorff distance of the borders over the diagonal; infinite if only one has any
  std::optional<double> features;  ///< the same of borders and model edges, if both know their model edges
  std::vector<std::pair<int, int>> intersections;      ///< pairs of the mesh's triangles
  std::vector<std::pair<int, int>> new_intersections;  ///< those where the reference has none
  ReferencePairs reference_pairs;
  FaultyEdges edges;
  double mean_size = 0;          ///< length of an edge if all triangles were equilateral and equal
  std::vector<double> off;       ///< per vertex: distance to the reference over its mean edge
  int farthest = -1;             ///< the vertex with the largest `off`
  std::vector<char> forced;      ///< per triangle, see forced_needles; empty if kappa is above 0.1
  int worst_unforced = -1;       ///< the triangle with the smallest kappa of those that are not forced
  double kappa_off_corners = 0;  ///< see needles.h; kappa_min if no model edges are known
  int worst_off_corners = -1;
  /// Mean kappa of triangles within one edge length of an interface line, and of all others, without those at
  /// borders and model edges; none where there are none. Equal where the result shows no trace of the cuts.
  std::optional<double> kappa_by_cuts, kappa_elsewhere;
  std::vector<PatchFault> patch_faults;  ///< see compare_patches
  std::vector<int> reversed;             ///< a triangle of each component
  std::optional<SheetFindings> sheets;   ///< where they meet; see compare_sheets
};

/// The distance between the surfaces that is allowed, over the local size; the unit of Deviation::ratio. An
/// edge that is farther off cuts through what it should follow, or a limb is missing. (Three edges that stand
/// for a circle deviate by 0.29 of their length.)
constexpr double most_deviation = 0.5;

/// Measures everything but the extent of patches, cut creases and the cleaning. Reads, where present, the
/// result's vertex columns `size` and `ref_face`, and face column `model` of both surfaces; the reference is
/// compared as it was before cuts (face column `origin`), and as the smooth surface where it has face column
/// `curved`. `lines`: those that the result was made with, or null. `samples`, `most`: as in
/// distance_between. `sheets_meet`: border vertices with the same coordinates are one. `least_size`: allowed
/// distances are those of sizes from it on. `shares`: what was measured in shares, or null.
Findings examine(const Surface& result, const Surface& reference, const Lines* lines, int samples,
                 double most = infinity, bool sheets_meet = false, double least_size = 0,
                 const std::vector<ShareFindings>* shares = nullptr);

/// Cuts the measurements of examine that take most time and memory into shares of at most `triangles`, which
/// may be separate jobs, and calls `take` for each. examine takes what `measure` returns for them.
void cut_examination(const Surface& result, const Surface& reference, int triangles, int samples, double most,
                     const TakeShare& take);

/// Returns the smaller half-edge of each edge at which the result is folded (lib/core/fold.h).
std::vector<int> find_folds(const Connectivity& result, const Mesh& reference, const Bvh& reference_tree);

/// Returns the smaller half-edge of each edge inside of the result that cuts off a crease: its ends are on
/// both sides of a model edge of more than 60 degrees (face column `model` of the reference), it is off the
/// surface between, and the other diagonal is on that edge. Throws: as opposite_halfedges.
std::vector<int> find_cut_creases(const Connectivity& result, const Surface& reference);

/// One figure of the report; NaN where a mesh has none.
struct Figure {
  std::string key, label;
  int decimals;  ///< or one of the two below
  double reference, result;
};
/// Instead of a number of decimals: a whole number; three significant digits.
constexpr int count_figure = -1, short_figure = -2;
/// Returns all figures, in the order of the table. Distances are over the reference's diagonal.
std::vector<Figure> figures(const Findings& findings);

constexpr double no_figure = std::numeric_limits<double>::quiet_NaN();

/// A kind of requirement, and its limit where it has one. The table of them is in contract.cc.
struct Requirement {
  std::string name;
  double limit = 0;
};
using Contract = std::vector<Requirement>;
/// What mcheck requires by default.
extern const char* const default_contract;

/// Parses a list such as "topology,intersections,kappa=0.1". Throws: BadUsage naming the item that is wrong.
Contract parse_contract(const std::string& list);

/// Returns whether a requirement's figure must be above its limit (kappa, angles), and not at most as large.
bool is_lower_limit(const Requirement& requirement);
/// Returns the figure that a requirement bounds; NaN if it has none (topology), or it was not measured.
double reached(const Requirement& requirement, const Findings& findings);

/// A requirement that is not met. Figures are NaN where it has none.
struct Failure {
  std::string requirement, fact;  ///< "kappa", "smallest is 0.03 in triangle 12 at (0 1 2), not above 0.1"
  double value = no_figure, limit = no_figure;
  int triangle = -1;  ///< the worst or the first, -1: none
  Vec3 place{no_figure, no_figure, no_figure};
};
/// Returns the requirements that are not met, in the order of the contract. `mesh`: the result.
std::vector<Failure> judge(const Contract& contract, const Findings& findings, const Mesh& mesh);

/// What a face offends against: bits.
enum Offense {
  offends_topology = 1,
  offends_intersections = 2,
  offends_folds = 4,
  offends_kappa = 8,
  offends_vertices = 16,
  offends_deviation = 32,
  offends_patches = 64,
  offends_creases = 128
};
/// Returns the faces of the result at which the contract fails, with face columns int `triangle` (row in the
/// result) and uchar `fault` (bits of Offense). Vertices stay, some unused.
Surface offending_faces(const Contract& contract, const Findings& findings, const Surface& result);

/// Returns the result's sizes per vertex, reduced where it is farther from the reference than the contract
/// allows, and next to offending faces. Returns them unchanged if the reference has more pairs that properly
/// intersect than triangles: smaller sizes do not help then. Requires: vertex column `size`.
std::vector<double> smaller_sizes(const Contract& contract, const Findings& findings, const Surface& result,
                                  const Mesh& reference);

/// Returns how many triangles these sizes ask for: on the result, and on the triangles of the reference that
/// are farther from it than the size at the nearest place, which is what msize --field gives them.
double triangles_asked_for(const Mesh& result, const std::vector<double>& size, const Mesh& reference);

}  // namespace meshpipe
