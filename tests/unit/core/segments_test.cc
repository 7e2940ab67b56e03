// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/segments.h"

#include <gtest/gtest.h>

#include <random>

using namespace meshpipe;

TEST(Segments, MeetUnlessTheyOnlyShareAnEnd) {
  //   2   3
  //    \ /      the diagonals of a square cross
  //    / \                                       .
  //   0   1
  const Vec2 p[] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  EXPECT_TRUE(meet({p[0], p[3], 0, 3}, {p[1], p[2], 1, 2}));
  EXPECT_FALSE(meet({p[0], p[1], 0, 1}, {p[2], p[3], 2, 3}));
  EXPECT_FALSE(meet({p[0], p[1], 0, 1}, {p[1], p[3], 1, 3}));
  EXPECT_TRUE(meet({p[0], p[1], 0, 1}, {p[1], p[0], 1, 0}));          // the same two ends
  EXPECT_TRUE(meet({p[0], p[1], 0, 1}, {{0.5, 0}, {0.5, 1}, 4, 5}));  // touching
  EXPECT_TRUE(meet({p[0], p[1], 0, 1}, {{0.5, 0}, {2, 0}, 4, 5}));    // overlapping
  EXPECT_TRUE(meet({p[0], p[1], 0, 1}, {p[0], {2, 0}, 0, 5}));        // along each other from a common end
  EXPECT_FALSE(meet({p[0], p[1], 0, 1}, {p[0], {-2, 0}, 0, 5}));      // away from each other
  EXPECT_FALSE(meet({p[0], p[1], 0, 1}, {{1.5, 0}, {2, 0}, 4, 5}));   // one line, apart
}

TEST(Segments, TreeFindsWhatAllPairsFind) {
  std::mt19937 random(7);
  auto number = [&] { return random() / 4294967296.0; };
  for (int n : {0, 1, 2, 3, 100, 333}) {
    std::vector<Segment> s;
    for (int i = 0; i < n; ++i) {
      const Vec2 p{number(), number()}, d{0.1 * number(), 0.1 * number()};
      s.push_back({p, p + d, 2 * i, 2 * i + 1});
    }
    std::vector<std::array<int, 2>> all;
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j)
        if (meet(s[i], s[j])) all.push_back({i, j});
    EXPECT_EQ(SegmentTree(s).crossings(), all);
    EXPECT_EQ(SegmentTree(s).crossings(2).size(), std::min<std::size_t>(2, all.size()));
  }
}

TEST(Segments, WindingCountsLoops) {
  // a square around a smaller one that turns the other way, and a stray segment of weight 0
  std::vector<Segment> s;
  auto square = [&](double r, int sign) {
    const Vec2 p[] = {{-r, -r}, {sign * r, -sign * r}, {r, r}, {-sign * r, sign * r}};
    for (int i = 0; i < 4; ++i) s.push_back({p[i], p[(i + 1) % 4], 0, 0});
  };
  square(2, 1);
  square(1, -1);
  s.push_back({{1.5, -5}, {1.5, 5}, 0, 0});
  const std::vector<int> weight{1, 1, 1, 1, 1, 1, 1, 1, 0};
  const SegmentTree tree(s);
  EXPECT_EQ(tree.winding({0, 0}, weight), 0);
  EXPECT_EQ(tree.winding({-1.5, 0}, weight), 1);
  EXPECT_EQ(tree.winding({-1.5, 1}, weight), 1);  // level with corners
  EXPECT_EQ(tree.winding({3, 0}, weight), 0);
}
