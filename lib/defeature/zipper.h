// SPDX-License-Identifier: BSD-3-Clause
// The editable surface on which narrow strips are closed.
#pragma once
#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "lib/core/edit_mesh.h"
#include "lib/core/take_rows.h"
#include "lib/defeature/defeature.h"

namespace meshpipe {

/// The angle between two lines, in radians, below which they bound a strip, and do not meet in a corner.
constexpr double strip_angle = 25 * std::numbers::pi / 180;

/// The angle between normals from which an edge without a line may be that of a step.
constexpr double sharp_edge_of_step = 40 * degree;

/// Lines of a surface: chains of hard edges between nodes. Nodes are where more or fewer than two hard edges
/// meet, or a line bends.
struct FeatureLines {
  std::vector<int> of;         ///< line of each half-edge, -1: not hard
  std::vector<int> given;      ///< number of the given line on each half-edge, -1: none
  std::vector<int> seam;       ///< per half-edge: 1 where two lines have become one, else -1
  std::vector<double> length;  ///< per line
  std::vector<char> open;      ///< per line: it ends at nodes
  std::vector<char> rank;  ///< per line: 0 edge of a wrinkle, 1 crease, 2 given or between patches, 3 border
};
/// Chains the hard edges of the mesh into lines. `given`: as in remove_small_features; `wrinkles`: per
/// half-edge, whether it is hard only as the edge of a wrinkle.
FeatureLines find_lines(const EditMesh& mesh, const Surface& surface, const std::vector<int>* given,
                        const std::vector<char>& wrinkles);

/// A merge of vertex `gone`, which was at `at`, into vertex `kept`, over the distance `width`.
struct Merge {
  int gone, kept;
  double width;
  Vec3 at;
  bool ear = false;  ///< `gone` was the outer corner of a flat ear that another merge had left
};

/// A surface whose vertices are merged. The edits make a simplicial map of a subdivision of the input onto
/// the result, so that no point moves farther than the vertices (`drift`).
struct MergedSurface {
  EditMesh mesh;
  std::vector<Vec3> points;
  std::vector<double> drift;      ///< per vertex: how far what was merged into it has come, at most
  std::vector<int> origin;        ///< per triangle: the one of the input
  std::vector<RowBetween> added;  ///< vertices on edges, after those of the input
  std::vector<Merge> merges;
  FeatureLines lines;

  /// Returns the normal of triangle t with twice its area as length.
  Vec3 normal(int t) const;
  double height(int t) const;
  bool is_model(int h) const { return mesh.opp[h] >= 0 && mesh.hard[h] && lines.rank[lines.of[h]] > 0; }
  bool is_sharp(int h) const;
  bool on_line(int v) const;
  /// Flags the vertices with a hard edge.
  std::vector<char> vertices_on_lines() const;
  bool is_corner(int v) const;
  /// Returns the smallest angle on the surface between successive sharp or hard edges at v; pi without any.
  double sharpest(int v) const;
};

/// Returns the first triangle of each region of at most `most` triangles, ascending, without regions that
/// have no edge for which bounds(h) holds. The search for the triangles of larger regions ends early.
template <class Bounds>
std::vector<int> small_regions(const EditMesh& mesh, int most, const Bounds& bounds) {
  enum : char { unseen, here, before };
  std::vector<char> seen(mesh.tris.size(), unseen);
  std::vector<int> first, region;
  for (int seed = 0; seed < (int)mesh.opp.size(); ++seed) {
    if (!bounds(seed) || mesh.dead(seed / 3) || seen[seed / 3] != unseen) continue;
    region.assign(1, seed / 3);
    seen[seed / 3] = here;
    bool small = true;  // not if it meets what an earlier search has left
    for (std::size_t i = 0; small && i < region.size(); ++i) {
      for (int h = 3 * region[i]; h < 3 * region[i] + 3; ++h) {
        const int u = mesh.opp[h] / 3;
        if (bounds(h) || seen[u] == here) continue;
        small = small && seen[u] == unseen;
        seen[u] = here;
        region.push_back(u);
      }
      small = small && (int)region.size() <= most;
    }
    for (int t : region) seen[t] = before;
    if (small) first.push_back(*std::min_element(region.begin(), region.end()));
  }
  std::sort(first.begin(), first.end());
  return first;
}

/// Removes small components with a border from the mesh of the surface, if the tolerance holds between them
/// and the rest, which starts there with that `drift` (per vertex).
std::vector<RemovedFeature> remove_fragments(const Surface& surface, const DefeatureOptions& options,
                                             EditMesh& mesh, std::vector<double>& drift);

/// Merges vertices of a surface.
class Zipper : public MergedSurface {
 public:
  /// Takes a surface and its mesh. `given`: as in remove_small_features; `banned`: flags of vertices that
  /// take no part.
  Zipper(const Surface& surface, EditMesh edited, const DefeatureOptions& options,
         const std::vector<int>* given, const std::vector<char>& banned);

  /// Merges across strips and contracts short lines, the narrowest first. Returns the number of merges.
  int close_strips();
  /// Contracts regions between lines that are smaller than the tolerance. Returns the number of merges.
  int contract_regions();
  /// Contracts places of three or more corners within half the tolerance. Returns the number of merges.
  int contract_clusters();

 private:
  /// An edge, or (apex >= 0) a triangle with a long hard edge h and its apex close to that.
  struct Candidate {
    double width;
    int h, from, to, apex;
    bool operator<(const Candidate& o) const {  // for a heap with the narrowest on top
      return width != o.width ? width > o.width : h != o.h ? h > o.h : apex > o.apex;
    }
  };
  /// Rank and length of a line, and something to tell equal ones apart.
  using Strength = std::array<double, 3>;
  /// A side of an edge a-b: the first hard edges there around a and b.
  struct Side {
    int a = -1, b = -1;  ///< half-edges in the triangles on this side, -1: none
    Vec3 along_a, along_b;
    bool parallel() const { return a >= 0 && angle(along_a, along_b) < strip_angle; }
  };

  std::vector<char> add_wrinkles();
  void add_folds();
  Side side_of(int h) const;
  Vec3 normal_beyond(int h) const;
  bool folded(const Side& side) const;
  bool is_strip(int h) const;
  std::array<Strength, 2> strengths(int h) const;
  bool may_merge(int h, int gone) const;
  bool merge(int h);
  void collapse(int h, int gone);
  bool is_flat_ear(int v, Vec3 p, Vec3 a, Vec3 b) const;
  void cut_flat_ears(int v);
  int split(int h, double t);
  bool close_cap(int h);
  void consider(std::vector<Candidate>& heap, int t) const;
  int run(std::vector<Candidate> heap);
  std::vector<int> ball(int center) const;
  bool makes_needle(const std::vector<int>& vertices) const;

  DefeatureOptions options_;
  std::vector<char> banned_;
  std::vector<int> region_;  ///< per vertex, of those to be contracted; -1: in none
};

}  // namespace meshpipe
