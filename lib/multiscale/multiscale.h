// SPDX-License-Identifier: BSD-3-Clause
// The line along which a long part of genus 0 falls into two (the paper's section 3).
#pragma once
#include "lib/core/connectivity.h"
#include "lib/multiscale/levels.h"

namespace meshpipe {

/// What a cut along the zero level of a field does to a part of genus 0.
struct Assessment {
  bool valid = false;        ///< both sides exist, each connected by edges; else the rest means nothing
  int loops = 0;             ///< border loops of both halves; 2: two disks
  double length = 0;         ///< of the zero level
  double smaller_share = 0;  ///< of the area, by thirds of triangles
};
/// Assesses the cut of a part along the zero level of a field (one value per vertex; above 0 is one side).
/// Requires: genus 0.
Assessment assess(const ConnectedPart& part, const std::vector<double>& field);

/// The maps by which a cut was found, of the part or a coarse model (lib/core/coarsen.h); for pictures.
struct CutMaps {
  FilledDisk disk;
  std::vector<Level> levels;
  std::vector<std::vector<Vec2>> lines;  ///< of each level, in its frame
  std::vector<double> field;             ///< of their vertices: its zero level is the cut, except for detail
};

/// Finds the best line that cuts a part in two: drawn through all levels of its Laplace maps in several
/// directions, and led to holes that would stay whole. `field` receives a value per vertex of the part, never
/// zero, whose zero level is the line; `share` is the share of the work (lib/core/progress.h).
CutMaps best_cut(const ConnectedPart& part, double share, std::vector<double>& field);

}  // namespace meshpipe
