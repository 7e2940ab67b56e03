// SPDX-License-Identifier: BSD-3-Clause
// Lines of the result: borders, model edges and interfaces between parts, divided by the size field (the
// paper's step 4).
#pragma once
#include "lib/core/chart.h"
#include "lib/core/mesh.h"
#include "lib/size/size.h"

namespace meshpipe {

enum LineKind { border_line = 0, model_line = 1, interface_line = 2 };

/// A point on edge (a, b) of the surface, which both of its charts have: a + t (b - a); a == b: the vertex.
struct LinePoint {
  int a, b;
  double t;
};

/// Points first .. first+count-1 of Lines::points, joined by segments in order. An open line contains both
/// its ends (vertices); a closed one repeats no point, and has a segment from the last to the first.
struct Line {
  int kind, tag, first, count, closed;
  int kept = 0;  ///< a border whose points are those of the input
};

struct LineUse {
  int line, part;
};

struct Lines {
  std::vector<Line> lines;
  std::vector<LineUse> uses;
  std::vector<LinePoint> points;
};

constexpr double corner_turn = 0.7;  ///< radians, at least: a regular octagon has 8 corners, a circle none

/// Marks the vertices that a remeshed surface keeps: ends and junctions of the mesh border and model edges;
/// vertices where these turn by more than corner_turn at every scale from their edges up to the size (so that
/// the zig-zag of scans has none); and sharp_peaks. Requires: vertex column `size`, face column `part`.
std::vector<char> model_corners(const Surface& surface);

/// Chains border edges, edges between parts and model edges into lines, which end at junctions, at
/// model_corners and where `tag` (per half-edge, or null) changes. Divides each evenly in the integral of 1/h
/// (lines.cc says how), then refines until lines meet in no chart except at common ends. With keep_border,
/// borders have exactly the input's points and their ends of other lines. If `sheets_meet`, borders with the
/// same coordinates (match_sheets) are copies of one line and are divided alike. Requires: vertex column
/// `size` (h), face column `part`; charts in part order, positively oriented. Throws: NotAdmissible without
/// sizes; BadInput naming a vertex whose size is not positive or a face whose part has no chart; GoalMissed
/// for sizes too small, or naming two lines that meet in a chart.
Lines make_lines(const Surface& surface, const std::vector<Chart>& charts,
                 const std::vector<int>* tag = nullptr, bool keep_border = false, bool sheets_meet = false);

/// Marks the vertices that a mesh with these lines keeps: model_corners, ends of border or model lines of two
/// tags and, if any line is `kept`, corners of the input's border (all without face column `origin`).
std::vector<char> line_corners(const Surface& surface, const Lines& lines);

}  // namespace meshpipe
