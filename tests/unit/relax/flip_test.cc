// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/relax/operations.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

// an edge a b that is too long, between c and d
const std::vector<std::string> two_flat{"e     c     f",  //
                                        "  a       b  ",  //
                                        "g     d     h"};
const char* const six = "abc bad eac cbf agd dhb";

TEST(Flip, ALongEdgeFlipsForShape) {
  Drawn m(drawn_surface(two_flat, six));
  const double area = m.area();
  flip_to_shape(m.s);
  EXPECT_EQ(m.edge('a', 'b'), -1);
  EXPECT_NE(m.edge('c', 'd'), -1);
  EXPECT_EQ(m.s.counts.flips, 1);
  EXPECT_DOUBLE_EQ(m.area(), area);
}

TEST(Flip, AModelEdgeStays) {
  Drawn m(drawn_surface(two_flat, six, "ab"));
  EXPECT_FALSE(may_flip(m.s, m.edge('a', 'b')));
  flip_to_shape(m.s);
  EXPECT_NE(m.edge('a', 'b'), -1);
}

TEST(Flip, ABorderEdgeStays) {
  Drawn m(drawn_surface(two_flat, six));
  EXPECT_FALSE(may_flip(m.s, m.edge('e', 'a')));
}

// c d passes b on the right, so that c d b would be folded over
TEST(Flip, NothingIsFoldedOver) {
  Drawn m(drawn_surface({"e       c   f",  //
                         "  a  b       ",  //
                         "g       d   h"},
                        six));
  EXPECT_FALSE(may_flip(m.s, m.edge('a', 'b')));
}

// the larger triangle faces up: the fold is undone
TEST(Flip, AFlatFoldFlipsBack) {
  Drawn m(drawn_surface({"e       c   f",  //
                         "  a  b       ",  //
                         "g       d   h"},
                        six));
  m.s.mesh.flip(m.edge('a', 'b'));
  EXPECT_TRUE(may_flip(m.s, m.edge('c', 'd')));
}

TEST(Flip, WhatDidNotChangeIsNotLookedAtAgain) {
  Drawn m(drawn_surface(two_flat, six));
  flip_to_shape(m.s);
  const int flips = m.s.counts.flips, seen = m.s.clocks.flipped;
  flip_to_shape(m.s);
  EXPECT_EQ(m.s.counts.flips, flips);
  EXPECT_GT(m.s.clocks.flipped, seen);
}

// at a rim both ends of a new edge may be joined outside the patch
TEST(Flip, FrozenVerticesAreNotJoined) {
  Drawn m(drawn_surface(two_flat, six));
  EXPECT_TRUE(may_flip(m.s, m.edge('a', 'b')));
  m.s.hold['c' - 'a'] = m.s.hold['d' - 'a'] = frozen;
  EXPECT_FALSE(may_flip(m.s, m.edge('a', 'b')));
}

}  // namespace
