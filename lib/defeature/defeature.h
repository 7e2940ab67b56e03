// SPDX-License-Identifier: BSD-3-Clause
// Removal of features that are narrower than a tolerance: strips, steps, slots, sliver patches, short model
// edges.
#pragma once
#include <string>
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// A connected place where features were removed.
struct RemovedFeature {
  Vec3 at;            ///< where it was widest
  double width = 0;   ///< the longest distance over which two vertices were merged, or a fragment was off
  double length = 0;  ///< diagonal of the box around the place
  int merged = 0;     ///< vertices; 0: a fragment
};

struct DefeatureReport {
  std::vector<RemovedFeature> removed;  ///< widest first
  int merged = 0;                       ///< vertices, in all
  double moved = 0;                     ///< no point of either surface is farther than this from the other
  std::vector<int> vanished;            ///< patches that have no face any more
  std::vector<int> face;   ///< per triangle of the result, the one of the input that it is part of
  std::vector<int> given;  ///< per half-edge of the result, the number of the given line on it, or -1
  bool stopped = false;    ///< only fragments were, since the surface would intersect itself
};

struct DefeatureOptions {
  double tolerance = 0;       ///< 0: nothing is removed
  bool keep_borders = false;  ///< no vertex of a border moves
  std::vector<char> plane{};  ///< flags of triangles whose vertices stay in their plane; empty: none
  std::vector<char> kept{};   ///< flags of triangles that stay if they are a fragment; empty: none
};

/// Closes strips between two lines (model edges, borders) at most `tolerance` wide, contracts short lines and
/// small regions between corners, merges corners with lines next to them, and removes loose fragments: small
/// components with a border, near the rest. No point moves farther than `tolerance`; other topology stays,
/// and so do strips from which the surface folds back (the rim of a thin plate, the bottom of a slot). Needs
/// face column `model`; all columns follow. `given`: per half-edge the number of a line stronger than
/// creases, or -1; or null. Throws: NotAdmissible at a vertex of several fans.
DefeatureReport remove_small_features(CutSurface surface, const DefeatureOptions& options,
                                      const std::vector<int>* given = nullptr);

struct Flips {
  int count = 0;
  double moved = 0;  ///< by those at folds, to 3e-6 of the diagonal: how far either surface is from the other
};

/// Flips edges at triangles of no height: below 3e-6 of the diagonal, rounding of single-precision
/// coordinates decides which way a triangle faces. Its longest edge is flipped if both new triangles are
/// higher and face as the neighbor does, which it must, too, if it is small but not flat. Also flips edges at
/// which the surface lies flat on itself, rims of thin bodies apart, if that unfolds it and moves it by no
/// more than `tolerance`. Both triangles get the face columns of the larger one. Edges between patches or
/// parts, and those with a number in `line` (per half-edge, -1: none) stay. Model bits are not kept.
Flips flip_caps_and_folds(CutSurface surface, const std::vector<int>& line, double tolerance);

/// Returns the remark "removed FEATURES moved DISTANCE" for mcheck: how far the surface may be off.
std::string remark_of(const DefeatureReport& report);
/// Returns the distance in such a remark; 0 for other texts.
double moved_by(const std::string& remark);

}  // namespace meshpipe
