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
  bool forced = false;  ///< do the model or a kept border force most of the bad triangles?
};

/// Returns the best of the edits around the first of these triangles, each tried on the neighborhood and
/// optimized there, if it improves on `s`. `thorough`: also pairs of edits, the second where the first leaves
/// its worst triangle.
std::optional<State> repaired(const State& s, const std::vector<int>& triangles, bool thorough,
                              const Judge& judge = {});

/// Repairs the triangles that are not good enough, the worst first, then vertices of a valence other than 5,
/// 6, 7. Stops after 200 + n/100 of them: beyond that the size field is at fault, not single triangles.
void repair_worst(State& s, Repairs& memory);

// --- missed_features.cc ---

/// A place of the reference that the mesh should be near, a triangle of the mesh that was near to it, and how
/// near.
struct Sample {
  Place place;
  int near = -1;
  int time = -1;
  double distance = 0;
};

/// Samples, and the mesh that they were last measured to.
struct Samples {
  std::vector<Sample> list;
  MeshTree search;
  /// Forgets the mesh: call it before they are used with another.
  void forget() {
    for (Sample& s : list) s.near = s.time = -1;
    search.forget();
  }
};

/// Returns the places of the reference that a mesh with edges of length h may miss: its vertices, and points
/// on its edges, at most h / 3 apart where it bends, 2 h elsewhere.
std::vector<Sample> feature_samples(const Reference& reference, double h);

/// Puts mesh vertices on missed features, the maxima of the one-sided distance of the samples from the mesh,
/// where that is more than `least` times the size, the farthest first, at most `most` of them. The vertices
/// stay there. Returns whether one was reached.
bool reach_features(State& s, Samples& samples, double least, int most);

/// Returns the distances of the samples from the mesh: exact where above `enough`, else upper bounds. Sets
/// the triangle that each is near.
std::vector<double> sample_distances(const State& s, Samples& samples, double enough);

// --- faults.cc ---

/// Pairs of triangles that intersect, sorted: those that do not on the reference, and the number of the
/// others.
struct Intersections {
  std::vector<std::pair<int, int>> pairs;
  int of_reference = 0;
};

/// Refines where triangles intersect but the reference does not, and where the two are farther apart than
/// half the size: there the reference is too thin or bends too much for the size. Ends with the least faults
/// it came to, when more rounds do not help; returns what still intersects.
Intersections remove_faults(State& s, Samples& samples);

}  // namespace meshpipe
