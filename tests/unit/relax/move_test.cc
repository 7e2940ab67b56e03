// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/relax/operations.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

// a hexagon whose center is at (4, 4)
const std::vector<std::string> hexagon{"  e   d  ",  //
                                       "         ",  //
                                       "f     g c",  //
                                       "         ",  //
                                       "  a   b  "};
const char* const fan = "abg bcg cdg deg efg fag";
constexpr int g = 'g' - 'a';

TEST(Move, AVertexGoesToTheMiddleOfItsStar) {
  Drawn m(drawn_surface(hexagon, fan));
  EXPECT_TRUE(move_vertex(m.s, g));
  for (int i = 0; i < 20; ++i) move_vertex(m.s, g);
  EXPECT_LT(norm(m.s.points[g] - Vec3{4, 4, 0}), 0.05);
  const Place& p = m.s.place[g];
  EXPECT_LT(norm(m.reference.walk.point(p) - m.s.points[g]), 1e-12);
}

TEST(Move, AVertexWhoseStarDidNotChangeIsNotTriedAgain) {
  Drawn m(drawn_surface(hexagon, fan));
  while (improve_vertex(m.s, g)) ASSERT_LT(m.s.counts.moves, 50);
  const int tried = m.s.clocks.tried[g];
  EXPECT_FALSE(improve_vertex(m.s, g));
  EXPECT_EQ(m.s.clocks.tried[g], tried);
  mark_changed(m.s, 0);
  improve_vertex(m.s, g);
  EXPECT_GT(m.s.clocks.tried[g], tried);
}

TEST(Move, HeldVerticesStay) {
  for (Hold hold : {fixed, anchored, frozen, paired}) {
    Drawn m(drawn_surface(hexagon, fan));
    m.s.hold[g] = hold;
    smooth(m.s, 3);
    EXPECT_EQ(m.s.points[g], (Vec3{6, 4, 0}));
  }
}

// to the middle, although the segment from a gets longer than 1.2 times the size there: the line is straight
TEST(Move, OnABorderItSlides) {
  Drawn m(drawn_surface({"f   e   d",  //
                         "         ",  //
                         "a b     c"},
                        "abe aef bcd bde"));
  ASSERT_EQ(m.s.hold[1], slides);
  EXPECT_TRUE(slide_vertex(m.s, 1));
  for (int i = 0; i < 20; ++i) slide_vertex(m.s, 1);
  EXPECT_EQ(m.s.points[1].y, 0);
  EXPECT_GT(m.s.points[1].x, 3);
  EXPECT_NEAR(m.s.points[1].x, 5, 0.01);
  EXPECT_GT(m.s.points[1].x, rules::longest_segment * m.s.target(1));
}

// from the bend to the middle, but only as far as the segment from a does not cut the bend
TEST(Move, ASlideCutsNoBend) {
  Drawn m(drawn_surface({"f    e    d",  //
                         "           ",  //
                         "a          ",  //
                         "  b       c"},
                        "abe aef bcd bde"));
  ASSERT_EQ(m.s.hold[1], slides);
  for (int i = 0; i < 20; ++i) slide_vertex(m.s, 1);
  const Vec3 b = m.s.points[1], bend{2, 0, 0}, chord = b - m.s.points[0];
  EXPECT_GT(b.x, 2);
  EXPECT_LT(norm(cross(chord, bend - m.s.points[0])),
            1.5 * rules::line_deviation * m.s.target(1) * norm(chord));
}

}  // namespace
