// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/relax/operations.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

const std::vector<std::string> square{"d   c",  //
                                      "     ",  //
                                      "a   b"};
const char* const halves = "abc acd";

TEST(Split, AVertexComesToTheMiddle) {
  Drawn m(drawn_surface(square, halves));
  ASSERT_TRUE(split_edge(m.s, m.edge('a', 'c')));
  EXPECT_EQ(m.s.mesh.live, 4);
  ASSERT_EQ(m.s.points.size(), 5u);
  EXPECT_EQ(m.s.points[4], (Vec3{2, 2, 0}));
  EXPECT_EQ(m.s.mesh.valence(4), 4);
  EXPECT_EQ(m.s.hold[4], loose);
  EXPECT_EQ(m.s.labels.patch, std::vector<int>(4, 1));
  EXPECT_DOUBLE_EQ(m.area(), 16);
  EXPECT_EQ(m.s.counts.splits, 1);
}

TEST(Split, OnABorderItSlides) {
  Drawn m(drawn_surface(square, halves));
  ASSERT_TRUE(split_edge(m.s, m.edge('a', 'b')));
  EXPECT_EQ(m.s.mesh.live, 3);
  EXPECT_EQ(m.s.hold[4], slides);
  EXPECT_EQ(m.s.points[4], (Vec3{2, 0, 0}));
  EXPECT_TRUE(m.s.mesh.on_border(4));
}

TEST(Split, ABorderThatIsKeptHasNoNewVertex) {
  Drawn m(drawn_surface(square, halves));
  m.s.keep_border = true;
  EXPECT_FALSE(split_edge(m.s, m.edge('a', 'b')));
  EXPECT_TRUE(split_edge(m.s, m.edge('a', 'c')));
}

TEST(Split, AModelEdgeBetweenCornersIsSplitOnItsLine) {
  Drawn m(drawn_surface(square, halves, "ac"));
  EXPECT_EQ(m.s.hold[0], fixed);  // three lines meet
  ASSERT_TRUE(split_edge(m.s, m.edge('a', 'c'), 0.25));
  EXPECT_EQ(m.s.hold[4], slides);
  EXPECT_EQ(m.s.points[4], (Vec3{1, 1, 0}));
}

TEST(Split, AnOpenSeamStays) {
  Drawn m(drawn_surface(square, halves));
  m.s.hold[0] = m.s.hold[1] = paired;
  EXPECT_FALSE(split_edge(m.s, m.edge('a', 'b')));
}

TEST(Split, TheLongestGoesFirstUntilThereAreEnough) {
  Drawn m(drawn_surface(square, halves));
  split_long(m.s, 1.2, 3);
  EXPECT_EQ(m.s.mesh.live, 4);
  EXPECT_EQ(m.edge('a', 'c'), -1);
  split_long(m.s, 1.2, 4);
  EXPECT_EQ(m.s.mesh.live, 4);
}

}  // namespace
