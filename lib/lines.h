// SPDX-License-Identifier: BSD-3-Clause
// Lines of the result: borders, model edges and interfaces between parts, divided by the size field (the
// paper's step 4).
#pragma once
#include "lib/chart.h"
#include "lib/mesh.h"

namespace meshpipe {

enum LineKind { border_line = 0, model_line = 1, interface_line = 2 };

/// A point on edge (a, b) of the surface at a + t (b - a); a == b: on the vertex. Both charts of the edge
/// know its (u,v).
struct LinePoint {
  int a, b;
  double t;
};

/// Points first .. first+count-1 of Lines::points; an open line has both ends (vertices), a closed one
/// repeats nothing. Segments join consecutive points, and the last to the first when closed.
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

/// Vertices that a remeshed surface keeps: ends and junctions of the mesh border and model edges, and where
/// these turn by more than `corner` radians at every scale from their edges up to the size (the zig-zag of
/// scans is no corner).
std::vector<char> model_corners(const Surface& surface, double corner = 0.7);

/// Vertices on the border that the input had: not those by which cutting divided one of its edges (both edges
/// belong to one triangle of face column `origin`, and are in line).
std::vector<char> input_border(const Surface& surface);

/// Chains the special edges (mesh border, part borders, model bits) into lines that end at junctions and
/// corners (a vertex where the number of special edges is not two, and model_corners), and divides each into
/// N = round(integral of 1/h) segments, at least 1 (3 if closed), equidistributed in that measure, h = column
/// `size` linear along edges; one more where rounding down would cut a bend of a border or model edge off.
/// Where a model edge bends so much that its segments would be more than h / 16 off it, they are shorter, down
/// to 0.8 h. No
/// two lines, nor a line and itself, cross or touch in any chart but at common ends: where the chords would,
/// or would lose the shape of a loop, the lines are refined. A line's points are the same in every chart that
/// uses it. Precondition: charts in part order, positively oriented. `tag`, if not null, is the label of each
/// half-edge's edge: lines end where it changes. With keep_border borders have exactly the input's points,
/// and those where lines meet them. Needs vertex column `size` and face column `part`.
/// Throws NotAdmissible if there are no sizes, BadInput naming the vertex whose size is not positive or the
/// face whose part has no chart, GoalMissed naming two lines that could not be kept apart in a chart.
Lines make_lines(const Surface& surface, const std::vector<Chart>& charts, double corner = 0.7,
                 const std::vector<int>* tag = nullptr, bool keep_border = false);

/// What a mesh with these lines keeps of a surface: model_corners, vertices where the label of lines changes,
/// and those of borders that are kept.
std::vector<char> line_corners(const Surface& surface, const Lines& lines);

}  // namespace meshpipe
