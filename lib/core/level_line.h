// SPDX-License-Identifier: BSD-3-Clause
// A line through the triangles of a mesh, as the boundary between two sides, and pulling it straight.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Where a line crosses the edge between vertices low < high: at this fraction of it from low, 0 < at < 1.
struct EdgeCrossing {
  int low, high;
  double at;
};

/// A line, given by the side of each vertex: +1 or -1, or 0 where the line runs through the vertex. It
/// crosses every edge between unlike sides once, and follows an edge with both ends on it if the triangles
/// there lie on different sides.
struct LevelLine {
  std::vector<signed char> sign;       ///< of each vertex
  std::vector<EdgeCrossing> crossing;  ///< sorted by the edge; one for each edge between unlike sides
};

/// Returns EdgeCrossing::at of the edge between low < high. Throws: std::logic_error if there is none.
double crossing_on(const LevelLine& line, int low, int high);

/// Whether a vertex keeps its side of a line, or may change sides.
enum class LineVertex : char { stays, moves };

/// Straightens the line on the unfolded surface: in each of `sweeps`, each crossing moves along its edge to
/// where the line is shortest between its neighbors (on the mesh's border, to where the line is perpendicular
/// to it), so that bends about as many edges wide vanish. Where the line comes within `snap`, a fraction of
/// the edge, of a vertex that `hold` lets move, it runs through it, and leaves it again on the inside of a
/// bend: so it may pass over vertices, but keeps the topology of both sides. It also runs through peaks of
/// less than 15 degrees that it passes next to. Only these two may make it longer. Requires: no pinched
/// vertices.
void pull_straight(const Connectivity& c, LevelLine& line, const std::vector<LineVertex>& hold, double snap,
                   int sweeps);

/// Returns the zero level of a field (one finite value per vertex, linear on triangles).
LevelLine zero_level(const Mesh& mesh, const std::vector<double>& field);

/// Returns a line of a part of a mesh as one of the whole mesh of n vertices, where vertices outside the part
/// have sign 1. `vertex`: per vertex of the part, its row in the whole.
LevelLine in_whole(const LevelLine& line, const std::vector<int>& vertex, std::size_t n);

}  // namespace meshpipe
