// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/segments.h"

#include <algorithm>

#include "lib/core/predicates.h"

namespace meshpipe {

int ray_crossing(Vec2 p, Vec2 from, Vec2 to) {
  if (from.y <= p.y && p.y < to.y) return orient2d(from, to, p) > 0 ? 1 : 0;
  if (to.y <= p.y && p.y < from.y) return orient2d(from, to, p) < 0 ? -1 : 0;
  return 0;
}

bool meet(const Segment& s, const Segment& t) {
  // two segments that leave a common end overlap if they leave it in the same direction
  auto overlap = [](Vec2 common, Vec2 a, Vec2 b) {
    return orient2d(common, a, b) == 0 && dot(a - common, b - common) >= 0;
  };
  const int same = (s.from == t.from) + (s.from == t.to) + (s.to == t.from) + (s.to == t.to);
  if (same > 1) return true;
  if (s.from == t.from) return overlap(s.p, s.q, t.q);
  if (s.from == t.to) return overlap(s.p, s.q, t.p);
  if (s.to == t.from) return overlap(s.q, s.p, t.q);
  if (s.to == t.to) return overlap(s.q, s.p, t.p);
  const int a = orient2d(s.p, s.q, t.p), b = orient2d(s.p, s.q, t.q);
  if (a * b > 0) return false;
  const int c = orient2d(t.p, t.q, s.p), d = orient2d(t.p, t.q, s.q);
  if (c * d > 0) return false;
  if (a != 0 || b != 0 || c != 0 || d != 0) return true;
  // all on one line
  auto apart = [](double a0, double a1, double b0, double b1) {
    return std::max(a0, a1) < std::min(b0, b1) || std::max(b0, b1) < std::min(a0, a1);
  };
  return !apart(s.p.x, s.q.x, t.p.x, t.q.x) && !apart(s.p.y, s.q.y, t.p.y, t.q.y);
}

SegmentTree::SegmentTree(const std::vector<Segment>& segments) : segments_(segments) {
  const int n = (int)segments.size();
  box_.resize(2 * n);
  for (int i = 0; i < n; ++i) {
    const Segment& s = segments[i];
    box_[n + i] = {lower(s.p, s.q), upper(s.p, s.q)};
  }
  for (int k = n - 1; k > 0; --k) {
    const Box &a = box_[2 * k], &b = box_[2 * k + 1];
    box_[k] = {lower(a.low, b.low), upper(a.high, b.high)};
  }
}

std::vector<std::array<int, 2>> SegmentTree::crossings(std::size_t most) const {
  const int n = (int)segments_.size();
  std::vector<std::array<int, 2>> pairs, stack;  // of segments; of nodes, each pair once
  if (n > 0) stack.push_back({1, 1});
  while (!stack.empty() && pairs.size() < most) {
    const int k = std::min(stack.back()[0], stack.back()[1]), m = std::max(stack.back()[0], stack.back()[1]);
    const Box &a = box_[k], &b = box_[m];
    stack.pop_back();
    if (!(b.low.x <= a.high.x && a.low.x <= b.high.x && b.low.y <= a.high.y && a.low.y <= b.high.y)) continue;
    if (k < n) {  // the higher node, or both
      stack.insert(stack.end(), {{2 * k, m == k ? 2 * k : m}, {2 * k + 1, m == k ? 2 * k + 1 : m}});
      if (m == k) stack.push_back({2 * k, 2 * k + 1});
    } else if (k < m && meet(segments_[k - n], segments_[m - n])) {
      pairs.push_back({k - n, m - n});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

int SegmentTree::winding(Vec2 p, const std::vector<int>& weight) const {
  const int n = (int)segments_.size();
  int turns = 0, stack[64], top = 0;
  if (n > 0) stack[top++] = 1;  // the root, or the only leaf
  while (top > 0) {
    const int k = stack[--top];
    const Box& b = box_[k];
    if (!(b.low.y <= p.y && p.y <= b.high.y && p.x <= b.high.x)) continue;
    if (k < n)
      for (int child : {2 * k + 1, 2 * k}) stack[top++] = child;
    else if (weight[k - n] != 0)
      turns += weight[k - n] * ray_crossing(p, segments_[k - n].p, segments_[k - n].q);
  }
  return turns;
}

}  // namespace meshpipe
