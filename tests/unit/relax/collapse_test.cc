// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/relax/operations.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

TEST(Collapse, AnInsideVertexOfValence4Goes) {
  Drawn m(drawn_surface({"  e   d  ",  //
                         "         ",  //
                         "f   gh  c",  //
                         "         ",  //
                         "  a   b  "},
                        "fag efg abg bhg bch cdh deg dgh"));
  remove_irregular(m.s);
  EXPECT_EQ(m.s.mesh.live, 6);
  EXPECT_LT(m.s.mesh.out['h' - 'a'], 0);
  EXPECT_EQ(m.s.counts.collapses, 1);
  EXPECT_NEAR(m.area(), 48, 1e-12);
}

const std::vector<std::string> straight{"f   e   d",  //
                                        "         ",  //
                                        "a   b   c"};
const char* const four = "abe aef bcd bde";

TEST(Collapse, AVertexGoesAlongAStraightBorder) {
  Drawn m(drawn_surface(straight, four));
  ASSERT_TRUE(collapse_edge(m.s, m.edge('a', 'b'), 'b' - 'a', {20, 3}));
  EXPECT_EQ(m.s.mesh.live, 3);
  EXPECT_NE(m.edge('a', 'c'), -1);
  EXPECT_DOUBLE_EQ(m.area(), 32);
}

TEST(Collapse, LimitsOfShapeAndLengthHold) {
  Drawn m(drawn_surface(straight, four));
  EXPECT_FALSE(collapse_edge(m.s, m.edge('a', 'b'), 'b' - 'a', {1.1, 3}));
  EXPECT_FALSE(collapse_edge(m.s, m.edge('a', 'b'), 'b' - 'a', {20, 1.1}));
  EXPECT_EQ(m.s.mesh.live, 4);
  EXPECT_EQ(m.s.counts.collapses, 0);
}

TEST(Collapse, ABentBorderKeepsItsVertex) {
  Drawn m(drawn_surface({"f   e   d",  //
                         "         ",  //
                         "a       c",  //
                         "    b    "},
                        four));
  EXPECT_FALSE(collapse_edge(m.s, m.edge('a', 'b'), 'b' - 'a', {20, 3}));
}

TEST(Collapse, AVertexOfThreeEdgesGoesAlsoBetweenLines) {
  Drawn m(drawn_surface({"    c    ",  //
                         "         ",  //
                         "    d    ",  //
                         "a       b"},
                        "abd bcd cad"));
  ASSERT_TRUE(collapse_edge(m.s, m.edge('d', 'a'), 'd' - 'a', {20, 3}));
  EXPECT_EQ(m.s.mesh.live, 1);
  EXPECT_DOUBLE_EQ(m.area(), 24);
  // of four edges it holds the sheet between them
  Drawn four(drawn_surface({"d       c",  //
                            "         ",  //
                            "    e    ",  //
                            "         ",  //
                            "a       b"},
                           "abe bce cde dae"));
  EXPECT_FALSE(collapse_edge(four.s, four.edge('e', 'a'), 'e' - 'a', {20, 3}));
  EXPECT_TRUE(collapse_edge(four.s, four.edge('e', 'a'), 'e' - 'a', rules::at_fault));
  EXPECT_DOUBLE_EQ(four.area(), 64);
}

TEST(Collapse, FromALineNothingGoesInside) {
  Drawn m(drawn_surface(straight, four));
  EXPECT_FALSE(collapse_edge(m.s, m.edge('b', 'e'), 'b' - 'a', {20, 3}));
}

TEST(Collapse, NothingGoesIntoAFrozenVertexAndNoFixedOneGoes) {
  Drawn m(drawn_surface(straight, four));
  m.s.hold[0] = frozen;
  EXPECT_FALSE(collapse_edge(m.s, m.edge('a', 'b'), 'b' - 'a', {20, 3}));
  m.s.hold[0] = slides, m.s.hold[1] = fixed;
  EXPECT_FALSE(collapse_edge(m.s, m.edge('a', 'b'), 'b' - 'a', {20, 3}));
  m.s.hold[1] = slides;
  EXPECT_TRUE(collapse_edge(m.s, m.edge('a', 'b'), 'b' - 'a', {20, 3}));
}

}  // namespace
