// SPDX-License-Identifier: BSD-3-Clause
// Noncrossing refinement: chains of edges are divided so that their segments are drawn in every chart as the
// chains are, without crossings, every loop with the same orientation and the same lines inside.
#pragma once
#include <vector>

#include "lib/core/chart.h"

namespace meshpipe {

/// A chain of edges: `count` vertices from Chains::vertex[first] on; a closed one repeats its first vertex at
/// its end. `left` and `right` are the parts on its sides (equal: inside one), -1 beyond the border.
struct Chain {
  int kind, first, count;
  bool closed;
  int left, right;
};

struct Chains {
  std::vector<Chain> chain;
  std::vector<int> vertex;
  std::vector<double> measure;  ///< integral of 1/h from the chain's start, per entry of `vertex`
  std::vector<double> ratio;    ///< per entry: relative change of h along the edge to the next one
  /// Per chain the first of those that are copies of one line where sheets meet, vertex by vertex at the same
  /// places, and are divided alike; empty: all are their own.
  std::vector<int> leader{};
};

/// A point of a divided chain: at t of the edge after its vertex `piece`, 0 <= t < 1 (0: on the vertex).
struct Cut {
  int piece;
  double t;
  double measure;
};

/// Per chain its cuts in order, both ends included.
using Division = std::vector<std::vector<Cut>>;

/// Returns the cuts that divide a chain into n segments of equal measure.
std::vector<Cut> divide(const Chains& chains, int line, int n);

/// Adds cuts until the segments of all chains form the same plane drawing in each chart as the chains do: no
/// two meet except at common ends, and loops keep their orientation, most of their area, and the lines inside
/// them. Neighboring segments of a refined line differ by at most a factor of three in measure. Ends, since a
/// chain cut at all its vertices is drawn as it is. `inside`: flags of vertices, on no line, that must stay
/// inside the segments around their part. Throws: GoalMissed naming part, lines and place if a chart is not
/// one-to-one.
void refine_until_noncrossing(const Chains& chains, const std::vector<Vec3>& points,
                              const std::vector<Chart>& charts, const std::vector<char>& inside,
                              Division& division);

}  // namespace meshpipe
