// SPDX-License-Identifier: BSD-3-Clause
// A line through the triangles of a mesh, as the boundary between two sides, and pulling it straight.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Where a line crosses the edge between two vertices, low < high: `at` from low, 0 < at < 1.
struct EdgeCrossing {
  int low, high;
  double at;
};

/// A line by the side of each vertex, +1 or -1, or 0 where it runs through the vertex. It crosses every edge
/// between unlike sides once, and follows an edge with both ends on it if the triangles there lie on
/// different sides.
struct LevelLine {
  std::vector<signed char> sign;       ///< of each vertex
  std::vector<EdgeCrossing> crossing;  ///< sorted by the edge; one for each edge between unlike sides
};

/// Returns where the line crosses the edge between low < high. Throws: std::logic_error if it does not.
double crossing_on(const LevelLine& line, int low, int high);

/// What becomes of a vertex when a line is pulled straight: it keeps its side, or it may change sides.
enum class Hold : char { stays, moves };

/// Pulls the line straight on the unfolded surface: `sweeps` times, each crossing moves along its edge to
/// where the line is shortest between its neighbors (those on the mesh's border to where it meets that at a
/// right angle), so that turns about as many edges wide vanish and longer ones stay. A line that comes within
/// `snap`, a fraction of the edge, of a vertex runs through it, and leaves it again if it is bent there, on
/// the inside; so it may pass over vertices, but keeps the topology of both sides. The line never gets longer
/// except by the snapping. Requires: no pinched vertices.
void pull_straight(const Connectivity& c, LevelLine& line, const std::vector<Hold>& hold, double snap,
                   int sweeps);

/// The zero level of a field on the vertices (finite numbers), linear on triangles.
LevelLine zero_level(const Mesh& mesh, const std::vector<double>& field);

/// The line of a part of a mesh as one of the whole mesh of n vertices, those of which that are not in the
/// part have sign 1; vertex[i] is the number in the whole.
LevelLine in_whole(const LevelLine& line, const std::vector<int>& vertex, std::size_t n);

}  // namespace meshpipe
