// SPDX-License-Identifier: BSD-3-Clause
// The few places that need more than sweeps; for lib/relax/ only.
#pragma once
#include "lib/relax/patch.h"

namespace meshpipe {

// --- repair.cc ---

/// What repair remembers between its calls.
struct Repairs {
  std::vector<int>
      failed[2];        ///< per triangle: when one edit was last tried there in vain, and when pairs were
  bool forced = false;  ///< do the model or a kept border force most of the bad triangles?
};

/// The best of the edits around the first of these triangles, each tried on the neighborhood and settled
/// there, if it is better than what is. `thorough`: also pairs of edits, the second where the first leaves
/// its worst triangle.
std::optional<State> repaired(const State& s, const std::vector<int>& triangles, bool thorough);

/// Repairs the triangles that are not good enough, the worst first, then vertices of a valence other than 5,
/// 6, 7. Stops after 200 + n/100 of them: beyond that the size field is at fault, not single triangles.
void repair_worst(State& s, Repairs& memory);

// --- missed_features.cc ---

/// A place of the reference that the mesh is to be near to, and a triangle of the mesh that was near to it.
struct Sample {
  Place place;
  int near = -1;
};

/// The places of the reference that a mesh with edges of length h may miss: its vertices, and where it bends,
/// points on its edges at most h / 3 apart.
std::vector<Sample> feature_samples(const Reference& reference, double h);

/// Puts mesh vertices on missed features, the maxima of the one-sided distance of the samples from the mesh,
/// where that is more than a tenth of the size, the farthest first. They stay there. Returns whether one was
/// reached.
bool reach_features(State& s, std::vector<Sample>& samples);

// --- separate.cc ---

/// Pairs of triangles that intersect, sorted: those that do not on the reference, and the number of the
/// others.
struct Intersections {
  std::vector<std::pair<int, int>> pairs;
  int of_reference = 0;
};

/// Refines where triangles intersect but the reference does not: there it is too thin or bends too much for
/// the size. Ends with the fewest intersections it came to, when more rounds do not help; returns what is
/// left.
Intersections separate(State& s);

}  // namespace meshpipe
