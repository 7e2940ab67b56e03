// SPDX-License-Identifier: BSD-3-Clause
// The multiscale Laplace partitioner of the paper's section 3: cuts a part of genus 0 and large aspect ratio
// in two.
#pragma once
#include "lib/levels.h"
#include "lib/mesh.h"
#include "lib/topology.h"

namespace meshpipe {

enum class CutMethod {
  multiscale,
  maxcut  ///< one map and one straight line (lib/maxcut.h), for comparison
};

struct MultiscaleOptions {
  CutMethod method = CutMethod::multiscale;
  double max_aspect = 4;    ///< eta_max of eq. (5)
  double min_area = 1e-10;  ///< A_min, relative to the level's disk
  int min_set = 10;         ///< smaller sets of small triangles stay good (the paper's footnote)
  int directions = 4;       ///< root directions tried
  int most_parts = 0;       ///< more are a failure (0: any number)
  bool keep_maps = false;   ///< fill MultiscaleCut::maps
};

/// What a cut was found with, for pictures: the part, or a coarse model of a large one (lib/coarsen.h).
struct CutMaps {
  FilledDisk disk;
  std::vector<Level> levels;
  std::vector<std::vector<Vec2>> lines;  ///< of each level, in its frame
  std::vector<double> field;             ///< of their vertices: its zero level is the cut, but for detail
};

/// One cut that was made.
struct MultiscaleCut {
  int part = 0;  ///< of the input, or the half of an earlier cut that was cut again
  /// Parts of the result; cut again themselves if they are the `part` of a later cut.
  int halves[2] = {0, 0};
  double eta = 0;       ///< eta_geo before
  int levels = 0;       ///< of Laplace maps
  double length = 0;    ///< of the cut line, over the diagonal of the part's bounding box
  int too_small = 0;    ///< with maxcut: triangles whose image is smaller than 1e-15
  int turned_over = 0;  ///< with maxcut: or has no positive area
  CutMaps maps = {};    ///< with keep_maps
};

/// Cuts every part (face column `part`) whose geodesic aspect ratio exceeds max_aspect, recursively, and
/// renumbers parts 0..n-1: halves keep the place of their part in the order. Each result is edge-connected,
/// vertex-manifold, touches itself nowhere, has genus 0, N_B >= 1. Triangles are split along the cut
/// (lib/cut.h). The cut follows the model's branches along opposite sides (lib/balance.h). Halves are joined
/// to neighbours where the union is admissible. Precondition: parts of genus 0 with a boundary.
/// Triangles of no part (-1) are left alone, and then nothing is joined. A part that cannot be cut, or that
/// twelve cuts do not make short enough, stays. Throws GoalMissed if more than most_parts are needed; with
/// maxcut also if one cut does not make two admissible halves, or its map loses more than a hundredth of the
/// triangles. Returns the number of parts; `cuts`, if given, receives what was done, in order, the cut that
/// failed last. `topology`, if given, receives that of the parts, `opposite`
/// the result's neighbours.
int multiscale_cut(Surface& surface, const MultiscaleOptions& options = {},
                   std::vector<MultiscaleCut>* cuts = nullptr, std::vector<Topology>* topology = nullptr,
                   std::vector<int>* opposite = nullptr);

}  // namespace meshpipe
