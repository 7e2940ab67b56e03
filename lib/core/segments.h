// SPDX-License-Identifier: BSD-3-Clause
// Segments in the plane: which of them meet, and how often they wind around a point; exact signs.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "lib/core/vec.h"

namespace meshpipe {

/// A segment from p to q. Ends with the same key (`from` of p, `to` of q) are the same point.
struct Segment {
  Vec2 p, q;
  int from, to;
};

/// A bounding-volume tree over consecutive segments. Efficient where neighbors in the list are near in the
/// plane. Keeps a reference to the segments.
class SegmentTree {
 public:
  explicit SegmentTree(const std::vector<Segment>& segments);

  /// Returns the pairs i < j of segments that meet elsewhere than at one common end, sorted; if there are
  /// more than `most`, as many of them.
  std::vector<std::array<int, 2>> crossings(std::size_t most = SIZE_MAX) const;

  /// Returns the winding number around p of the segments, each counted weight[i] times (0: not at all); they
  /// form loops. Requires: p lies on none of those with a weight.
  int winding(Vec2 p, const std::vector<int>& weight) const;

 private:
  struct Box {
    Vec2 low, high;
  };
  const std::vector<Segment>& segments_;
  std::vector<Box> box_;  ///< node k has children 2 k and 2 k + 1; leaves are nodes n .. 2 n - 1
};

/// Returns how the segment crosses the ray from p along +x: +1 upwards, -1 downwards, 0 if it does not. The
/// sum over a loop is its winding number around p.
int ray_crossing(Vec2 p, Vec2 from, Vec2 to);

/// Returns the distance of p from the segment from a to b, in the plane or in space.
template <class Point>
double distance_to_segment(Point p, Point a, Point b) {
  return norm(a + nearest_fraction(p, a, b) * (b - a) - p);
}

/// Returns whether two segments meet elsewhere than at one common end: they cross, touch or overlap.
bool meet(const Segment& s, const Segment& t);

}  // namespace meshpipe
