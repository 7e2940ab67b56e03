// SPDX-License-Identifier: BSD-3-Clause
// A surface while it is repaired, passed between the steps of clean().
#pragma once
#include <vector>

#include "lib/clean/clean.h"
#include "lib/core/fan.h"

namespace meshpipe {

/// A surface under repair: triangles, their rows in the input, neighbors across edges of two triangles.
struct Repair {
  std::vector<Tri> tris;
  std::vector<int> face;      ///< triangle of the input; of one that fills a hole ~ the one it is a copy of
  std::vector<int> vertex;    ///< vertex of the input; copies made by splitting come last
  std::vector<int> copied;    ///< the vertex that each of them is a copy of
  std::vector<int> opposite;  ///< half-edges; may run in the same direction until the surface is oriented
  std::vector<char> split;    ///< flags vertices of non-manifold edges
  std::vector<char> flipped;  ///< flags triangles whose orientation was reversed
};

inline Vec3 point(const Repair& r, const std::vector<Vec3>& points, int v) { return points[r.vertex[v]]; }
/// Returns the normal of triangle t with twice its area as length. `points`: of the input.
inline Vec3 area_vector(const Repair& r, const std::vector<Vec3>& points, int t) {
  const auto& [i, j, k] = r.tris[t];
  return area_vector(point(r, points, i), point(r, points, j), point(r, points, k));
}

/// Returns the vertex that v is a copy of, or v.
inline int base(const Repair& r, int v) {
  const int n = (int)(r.vertex.size() - r.copied.size());
  return v < n ? v : r.copied[v - n];
}

/// Returns the triangle of the input from which triangle t has its columns.
inline int source(const Repair& r, int t) { return r.face[t] < 0 ? ~r.face[t] : r.face[t]; }

/// Returns the half-edges without a neighbor, ascending.
inline std::vector<int> border_half_edges(const Repair& r) {
  std::vector<int> border;
  for (int h = 0; h < (int)r.opposite.size(); ++h)
    if (r.opposite[h] < 0) border.push_back(h);
  return border;
}

/// Records a fault of a triangle of the input; triangles that fill holes (negative) have none.
inline void record(CleanReport& report, int triangle, Fault fault) {
  if (triangle >= 0) report.offending.push_back({triangle, fault});
}

/// Returns SheetCounts::solids from `doubles` (pairs of input triangles: kept, dropped); empty if a patch is
/// on both sides of a triangle, or is not positive.
std::vector<std::array<int, 2>> solids_of_patches(const Repair& r, const Surface& input,
                                                  const std::vector<std::array<int, 2>>& doubles);

/// Returns the distance that rounding may leave between copies of a point, from the largest coordinate of
/// used vertices and whether all have single precision.
double coordinate_noise(const Mesh& mesh, const std::vector<char>& used);

/// Flags the vertices same[v] (see first_equal) for the ends v of edges longer than 0 and at most
/// `tolerance`; empty if there are none.
std::vector<char> ends_of_short_edges(const Mesh& mesh, const std::vector<int>& same, double tolerance);

/// Merges candidates no farther apart than `tolerance`, as merge_near, where all edges that leave the merged
/// vertex are at least 100 times as long. Returns the number of vertices merged.
int merge_noise(const Mesh& mesh, const std::vector<char>& candidates, double tolerance,
                std::vector<int>& same);

/// Merges clusters of vertices whose bounding box is by many orders of magnitude smaller than all edges that
/// leave it, and that are no thin part of the surface. Returns the number merged, and raises `within` to the
/// largest distance of two that are merged. Time O(n log n).
int merge_clusters(const Mesh& mesh, std::vector<int>& same, double& within);

/// Returns the half-edges without a neighbor of a mesh whose vertices are welded, ascending.
std::vector<int> open_edges(const Mesh& mesh, const std::vector<int>& same);

/// Merges border vertices whose distance is far below all their edges, where that closes border edges and
/// lays no sheets on each other. Returns the number merged, and raises `within` as merge_clusters does.
/// `open`: as open_edges returns them. Time O(n log n).
int merge_seams(const Mesh& mesh, std::vector<int> open, std::vector<int>& same, double& within);

/// Merges vertices on both sides of the ends of slits, and divides triangles at edges without a neighbor
/// where other such edges run along them with vertices in between, as on two sides of a slit of which one has
/// more vertices: at most HoleCounts::slit away. The report counts both. Returns whether there were any.
/// Requires: either all or no neighbors are known. Afterwards none are.
bool close_slits(Repair& r, const std::vector<Vec3>& points, CleanReport& report);

/// Drops the triangles with gone != 0; the others keep their order, and edges next to a gap become border.
void drop(Repair& r, const std::vector<char>& gone);

/// Reverses a triangle: its half-edges 0 1 2 become 2 1 0.
void flip(Repair& r, int t);

/// Finds neighbors, and drops triangles that lie on others (drop_doubles). The report keeps the number of
/// non-manifold edges of the first call.
void join(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options, CleanReport& report);

/// Flags in `gone` the second copies of triangles (`same`: pairs, the first and a later one), and both of
/// fins too small to be meant. Unless sheets are split, also pairs that divide a flat quadrilateral along its
/// other diagonal. If they are paired, both copies stay where two solids touch, as each is closed by its own.
/// Returns the number of triangles with a kept double.
int drop_doubles(const Repair& r, const std::vector<Vec3>& points,
                 const std::vector<std::array<int, 2>>& same, CleanOptions::Sheets sheets,
                 std::vector<char>& gone);

/// Connects the triangles of edges with four or more in pairs, where they and all that is connected with them
/// form closed solids: neighbors in angular order that bound the same solid, so that solids that touch along
/// an edge are closed one by one; where copies of vertices would not separate these pairs, those that bound
/// the same gap. Other edges stay open. Returns the number of edges connected. Requires: consistent
/// orientation.
int pair_edges(Repair& r, const std::vector<Vec3>& points);

/// Orients neighbors consistently, by the majority of each component. Components that are not orientable are
/// cut open; or, with drop_nonorientable, reported and their triangles flagged in `gone`.
void orient(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options, std::vector<char>& gone,
            CleanReport& report);

/// Gives every fan of triangles at a vertex except the first its own copy of the vertex. The result is an
/// oriented manifold: triangles of an open edge lie in one fan at either end, in opposite directions. The
/// report keeps the counts of the first call.
void split_fans(Repair& r, CleanReport& report);

/// Undoes split_fans: copies become the vertex again.
void unite(Repair& r);

/// Orients closed components away from what they enclose: outward, or inward within an odd number of others.
/// Leaves nested components alone if all are outward (each may be a solid), and those whose volume or place
/// is unclear (one touches another). Returns whether some are nested and all outward. `component`: 0..n-1.
bool face_outward(Repair& r, const std::vector<Vec3>& points, const std::vector<int>& component, int n);

struct FlatCounts {
  std::vector<int> removed;  ///< their `face`
  int left = 0;              ///< flat triangles that could not go without opening a crack
};

/// Removes triangles without height from an oriented manifold; the surface stays the same set of points. A
/// cap (the third vertex lies on the longest edge) has that edge flipped, or is dropped on the border; a
/// needle (two vertices almost coincide) collapses.
FlatCounts remove_flat(Repair& r, const std::vector<Vec3>& points);

/// Fills border loops of at most `most` edges by the triangulation of least area (cubic in the number of
/// edges; of loops with more than 1000, ears are cut first). New triangles come last and copy the columns of
/// the first neighbor of their loop.
HoleCounts fill_holes(Repair& r, const std::vector<Vec3>& points, int most);

/// Returns per triangle the number of the filled hole that it belongs to, or -1.
std::vector<int> caps_of(const Repair& r);

/// Marks edges between sheets in face column `model`, and gives each sheet that meets others a patch of its
/// own (report.sheets.patches). `apart`: the same triangles with the connectivity of the sheets. Returns
/// whether anything was changed.
bool mark_sheets(Surface& surface, const Repair& apart, CleanReport& report);

/// Flags the triangles of closed components that have vertices the input does not have, and less than 1e-6 of
/// the volume; `n_crumbs` becomes the number of such components. Requires: an oriented manifold.
std::vector<char> find_crumbs(const Mesh& mesh, const Mesh& input, int& n_crumbs);

/// Returns the clause on how many triangles there were, and why none is left.
std::string describe_nothing_left(const CleanReport& report);

}  // namespace meshpipe
