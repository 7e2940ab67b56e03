// SPDX-License-Identifier: BSD-3-Clause
// The few places that need more than sweeps; for lib/relax/ only.
#pragma once
#include "lib/relax/mesh_tree.h"
#include "lib/relax/patch.h"

namespace meshpipe {

// --- repair.cc ---

/// What repair remembers between its calls.
struct Repairs {
  /// Per triangle: when one edit was last tried there in vain, and when pairs were.
  std::vector<int> failed[2];
  std::vector<double> quality;  ///< per triangle, at `time`
  int time = -1;
  int in_vain = 0;      ///< triangles at which pairs of edits have failed
  bool forced = false;  ///< do the model or a kept border force most of the bad triangles?
};

/// Tries each edit around the first of these triangles (Judge::at) on a copy of the neighborhood, optimized
/// there. Returns the best if it improves on `s` by the judge. `thorough`: also pairs of edits, the second
/// where the first leaves its worst triangle.
std::optional<State> repaired(const State& s, const std::vector<int>& triangles, bool thorough,
                              const Judge& judge = {});

/// Repairs the triangles that are not good enough, the worst first, then vertices of a valence other than 5,
/// 6, 7: in each of 4 rounds at most 200 + n/100 of n triangles, since more mean that sizes are at fault.
/// Only where something has changed after `since`, on the clock of `s`. From `most_live` triangles on
/// none are added, except for needles.
void repair_worst(State& s, Repairs& memory, int since = -1, int most_live = INT_MAX);

// --- bends.cc ---

/// Returns whether a walk from v, or a slide along its line, ends at p.
bool reaches(const State& s, int v, Vec3 p, bool on_line);
/// Returns edits that put corners of t, or new vertices on its edges, where the reference bends near it.
std::vector<Edit> edits_to_bends(const State& s, int t);
/// Makes such an edit, and holds the vertex there. Returns false, and changes nothing, if no walk leads
/// there.
bool reach(State& s, const Edit& edit);

// --- missed_features.cc ---

/// A place of the reference that the mesh should be near, the triangle of the mesh that was near to it at
/// `time`, and their distance.
struct Sample {
  Place place;
  int near = -1;
  int time = -1;
  double distance = 0;
};

/// Samples, and the search tree of the mesh to which they were last measured.
struct Samples {
  std::vector<Sample> list;
  MeshTree search;
  /// Forgets the mesh: to be called before the samples are used with another.
  void forget() {
    for (Sample& s : list) s.near = s.time = -1;
    search.forget();
  }
  /// Goes back to an earlier mesh, whose samples were these; places inside triangles that were added since
  /// stay.
  void go_back(std::vector<Sample> earlier);
};

/// Returns the places of the reference that a mesh with edges of length h may miss: its vertices, and points
/// on its edges, at most h / 3 apart where it bends, 2 h elsewhere.
std::vector<Sample> feature_samples(const Reference& reference, double h);

/// Puts vertices of the mesh on missed features: maxima of the distance of the samples from the mesh that
/// exceed `least` times the size, the farthest first, at most `most` of them, of a hundred times as many that
/// are looked at. The vertices stay there. Returns whether one was reached.
bool reach_features(State& s, Samples& samples, double least, int most);

/// Returns the distances of the samples from the mesh: exact where above `enough`, else upper bounds. Sets
/// the nearest triangle of each sample.
std::vector<double> sample_distances(const State& s, Samples& samples, double enough);

// --- remove_faults.cc ---

/// Pairs of triangles that intersect where the reference does not, sorted; and the number of all others.
struct Intersections {
  std::vector<std::pair<int, int>> pairs;
  int of_reference = 0;
};

/// A place where triangles are too large, and the factor on their size that may do.
struct SizeReduction {
  Vec3 at;
  double factor;
};

/// What removal of faults has left.
struct Faults : Intersections {
  int count = 0;      ///< of pairs and folds
  double sum = 0;     ///< of these, of distances, and of 1/kappa of needles, over what is bearable
  double lowest = 0;  ///< sum of any mesh seen, which may have pairs although the result has none
  /// Where to reduce sizes before another start; empty: mcheck accepts the result, or sizes do not help.
  std::vector<SizeReduction> reductions{};
  /// Returns whether this is less: a mesh without pairs and folds is better than any with them.
  bool less_than(const Faults& other) const;
};

/// Repairs pairs of triangles that intersect where the reference does not; refines there, where the mesh
/// folds, at needles, and where mesh and reference are almost half the size apart; then repairs there. Goes
/// on as long as this helps, then, if mcheck accepts none and few needles are left, without a margin. If
/// mcheck accepts one of the meshes seen, leaves the best of these, with its mild needles repaired; else the
/// one with the fewest faults, which it returns. Where their sum is over rules::most_sum at first, it removes
/// none.
Faults remove_faults(State& s, Samples& samples);

}  // namespace meshpipe
