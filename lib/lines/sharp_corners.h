// SPDX-License-Identifier: BSD-3-Clause
// Divisions of lines that meet in a sharp corner.
#pragma once
#include "lib/core/connectivity.h"
#include "lib/lines/noncrossing.h"

namespace meshpipe {

/// Divides lines (borders, model edges) anew next to vertices where two of them bound a sector of less than
/// 1/8 radian. One triangle as long as the size (per vertex) fills its end; from there on, segments are 8
/// times as long as the sector is wide, and on both lines at the same distances, until the segments of
/// `division` are shorter. (A size field cannot ask for that, since it changes gradually.) Lines that would
/// take more than 300 cuts stay as they are. Of copies (Chains::leader) the first is divided.
void divide_at_sharp_corners(const Connectivity& mesh, const std::vector<double>& size, const Chains& chains,
                             Division& division);

}  // namespace meshpipe
