// SPDX-License-Identifier: BSD-3-Clause
// Segments in the plane: which of them meet, and how often they wind around a point; exact signs.
#pragma once
#include <array>
#include <vector>

#include "lib/core/vec.h"

namespace meshpipe {

/// From p to q; ends with the same key are the same point.
struct Segment {
  Vec2 p, q;
  int from, to;
};

/// Bounding-volume tree over consecutive segments. Efficient where neighbors in the list are near in the
/// plane, at any scale, which varies by orders of magnitude within a chart. Keeps a reference to the
/// segments.
class SegmentTree {
 public:
  explicit SegmentTree(const std::vector<Segment>& segments);

  /// Pairs i < j, in order, of segments that cross, touch or overlap elsewhere than at one common end.
  std::vector<std::array<int, 2>> crossings() const;

  /// Turns around p of the segments i with weight[i] != 0, each counted weight[i] times: the winding number
  /// where they form loops. p is on none of them.
  int winding(Vec2 p, const std::vector<int>& weight) const;

 private:
  struct Box {
    Vec2 low, high;
  };
  template <class Overlaps, class Visit>
  void visit(const Overlaps& overlaps, const Visit& leaf) const;

  const std::vector<Segment>& segments_;
  std::vector<Box> box_;  ///< node k has children 2 k and 2 k + 1; leaves are nodes n .. 2 n - 1
};

/// Turns of one segment as seen from p: the crossings of the ray from p along +x, counted upwards.
int ray_crossing(Vec2 p, Vec2 from, Vec2 to);

/// Distance of p from the segment from a to b, in the plane or in space.
template <class Point>
double distance_to_segment(Point p, Point a, Point b) {
  return norm(a + nearest_fraction(p, a, b) * (b - a) - p);
}

/// True if two segments meet elsewhere than at one common end.
bool meet(const Segment& s, const Segment& t);

}  // namespace meshpipe
