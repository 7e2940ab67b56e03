// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/edit_mesh.h"

#include <gtest/gtest.h>

using namespace meshpipe;

namespace {

/// What must hold after every operation.
void expect_sound(const EditMesh& m) {
  int live = 0;
  for (int t = 0; t < (int)m.tris.size(); ++t) {
    if (m.dead(t)) continue;
    ++live;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      ASSERT_GE(m.out[m.from(h)], 0);
      EXPECT_EQ(m.from(m.out[m.from(h)]), m.from(h));
      if (m.opp[h] < 0) {
        EXPECT_EQ(m.out[m.from(h)], h) << "the border's half-edge leads a border vertex";
        continue;
      }
      EXPECT_FALSE(m.dead(m.opp[h] / 3));
      EXPECT_EQ(m.opp[m.opp[h]], h);
      EXPECT_EQ(m.from(m.opp[h]), m.to(h));
      EXPECT_EQ(m.to(m.opp[h]), m.from(h));
      EXPECT_EQ(m.hard[h], m.hard[m.opp[h]]);
    }
  }
  EXPECT_EQ(live, m.live);
}

//  6---7---8
//  |\ 1|\  |     a 3 x 3 grid, 8 triangles, diagonals as drawn
//  |0\ | \ |
//  3---4---5
//  |\  |\  |
//  | \ | \ |
//  0---1---2
EditMesh two_by_two() {
  std::vector<Tri> t;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      int a = 3 * y + x;
      t.push_back({a, a + 1, a + 3});
      t.push_back({a + 1, a + 4, a + 3});
    }
  return EditMesh(t, 9, {});
}

int half_edge(const EditMesh& m, int a, int b) {
  for (int h = 0; h < (int)m.opp.size(); ++h)
    if (!m.dead(h / 3) && m.from(h) == a && m.to(h) == b) return h;
  return -1;
}

TEST(EditMesh, StarsAndValences) {
  EditMesh m = two_by_two();
  expect_sound(m);
  EXPECT_EQ(m.valence(4), 6);
  EXPECT_EQ(m.valence(0), 2);
  EXPECT_EQ(m.valence(2), 3);
  EXPECT_FALSE(m.on_border(4));
  EXPECT_TRUE(m.on_border(5));
  EXPECT_TRUE(m.joined(4, 2));
  EXPECT_FALSE(m.joined(4, 0));
}

TEST(EditMesh, FlipTurnsTheEdge) {
  EditMesh m = two_by_two();
  m.flip(half_edge(m, 1, 3));
  expect_sound(m);
  EXPECT_TRUE(m.joined(0, 4));
  EXPECT_FALSE(m.joined(1, 3));
  EXPECT_EQ(m.valence(4), 7);
  m.flip(half_edge(m, 0, 4));
  expect_sound(m);
  EXPECT_TRUE(m.joined(1, 3));
}

TEST(EditMesh, FlipKeepsHardEdgesInPlace) {
  EditMesh m(two_by_two().tris, 9, {0, 0b001, 0, 0, 0, 0, 0, 0});  // edge 1-4 of triangle 1
  m.flip(half_edge(m, 1, 3));
  expect_sound(m);
  EXPECT_TRUE(m.hard[half_edge(m, 1, 4)]);
  EXPECT_FALSE(m.hard[half_edge(m, 0, 4)]);
}

TEST(EditMesh, SplitAddsAVertexOfValenceFour) {
  EditMesh m = two_by_two();
  int v = m.split(half_edge(m, 1, 4));
  EXPECT_EQ(v, 9);
  expect_sound(m);
  EXPECT_EQ(m.valence(9), 4);
  EXPECT_EQ(m.live, 10);
  EXPECT_FALSE(m.joined(1, 4));
  v = m.split(half_edge(m, 1, 3));  // next to the border
  expect_sound(m);
  EXPECT_EQ(m.valence(v), 4);
}

TEST(EditMesh, CollapseTakesAVertexOut) {
  EditMesh m = two_by_two();
  const int v = m.split(half_edge(m, 4, 3));
  const int h = half_edge(m, v, 4);
  ASSERT_TRUE(m.can_collapse(h, v));
  m.collapse(h, v);
  expect_sound(m);
  EXPECT_EQ(m.live, 8);
  EXPECT_TRUE(m.joined(3, 4));
  EXPECT_LT(m.out[v], 0);
}

//    2
//   /|\.    v, with the three neighbors 0, 1, 2, goes into any of them, or takes in a neighbor
//  / v \.
// 0-----1
TEST(EditMesh, VerticesOfValenceThreeCollapse) {
  const std::vector<Tri> octahedron_top{{0, 1, 6}, {1, 2, 6}, {2, 0, 6}, {0, 3, 1}, {1, 4, 2},
                                        {2, 5, 0}, {3, 4, 1}, {4, 5, 2}, {5, 3, 0}, {3, 5, 4}};
  for (bool out : {false, true}) {
    EditMesh m(octahedron_top, 7, {});
    expect_sound(m);
    ASSERT_EQ(m.valence(6), 3);
    const int gone = out ? 6 : 0, h = half_edge(m, gone, out ? 0 : 6);
    ASSERT_TRUE(m.can_collapse(h, gone));
    m.collapse(h, gone);
    expect_sound(m);
    EXPECT_EQ(m.live, 8);
  }
}

TEST(EditMesh, CollapseIntoTheBorder) {
  EditMesh m = two_by_two();
  const int h = half_edge(m, 4, 5);
  EXPECT_FALSE(m.can_collapse(h, 5)) << "the border does not leave its line";
  ASSERT_TRUE(m.can_collapse(h, 4));
  m.collapse(h, 4);
  expect_sound(m);
  EXPECT_EQ(m.live, 6);
}

TEST(EditMesh, CollapseAlongTheBorderEitherWay) {
  for (int gone : {1, 2}) {
    EditMesh m = two_by_two();
    const int h = half_edge(m, 1, 2);
    ASSERT_LT(m.opp[h], 0);
    ASSERT_TRUE(m.can_collapse(h, gone));
    m.collapse(h, gone);
    expect_sound(m);
    EXPECT_EQ(m.live, 7);
    EXPECT_TRUE(m.joined(0, 3 - gone));
  }
}

// Vertex 0 has one triangle. Merged along the border it takes that with it.
TEST(EditMesh, TheEarOfABorderMergesOnly) {
  EditMesh m = two_by_two();
  const int h = half_edge(m, 0, 1);
  EXPECT_FALSE(m.can_collapse(h, 0));
  ASSERT_TRUE(m.can_collapse(h, 0, true));
  m.collapse(h, 0);
  expect_sound(m);
  EXPECT_EQ(m.live, 7);
  EXPECT_LT(m.opp[half_edge(m, 1, 3) < 0 ? half_edge(m, 3, 1) : half_edge(m, 1, 3)], 0);
  EditMesh alone({{0, 1, 2}}, 3, {});
  EXPECT_FALSE(alone.can_collapse(0, 0, true));
}

TEST(EditMesh, CollapseAlongAModelEdge) {
  // the line 1-4-7 through the middle
  EditMesh m(two_by_two().tris, 9, {0, 0b001, 0, 0, 0, 0b001, 0, 0});
  EXPECT_TRUE(m.hard[half_edge(m, 4, 7)]);
  EXPECT_FALSE(m.can_collapse(half_edge(m, 4, 5), 4)) << "a vertex goes along its line only";
  ASSERT_TRUE(m.can_collapse(half_edge(m, 4, 7), 4));
  m.collapse(half_edge(m, 4, 7), 4);
  expect_sound(m);
  EXPECT_TRUE(m.hard[half_edge(m, 1, 7)]);
}

TEST(EditMesh, ATetrahedronCannotCollapse) {
  EditMesh m({{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, 4, {});
  for (int h = 0; h < 12; ++h)
    for (int gone : {m.from(h), m.to(h)}) EXPECT_FALSE(m.can_collapse(h, gone));
}

//   c          c
//  / \        /|\.      the border edge a-b is split; both halves are border
// a---b  ->  a-m-b
TEST(EditMesh, SplitsABorderEdge) {
  EditMesh m({{0, 1, 2}}, 3, {});
  const int v = m.split(0);
  EXPECT_EQ(v, 3);
  EXPECT_EQ(m.live, 2);
  EXPECT_EQ(m.tris[0], (Tri{0, 3, 2}));
  EXPECT_EQ(m.tris[1], (Tri{3, 1, 2}));
  EXPECT_TRUE(m.on_border(3));
  EXPECT_EQ(m.valence(3), 3);
  EXPECT_EQ(m.valence(2), 3);
  EXPECT_EQ(m.opp[1], 5);
  EXPECT_EQ(m.hard[0] + m.hard[3] + m.hard[4] + m.hard[2], 4);
  EXPECT_EQ(m.hard[1] + m.hard[5], 0);
}

//    c
//   / \.
//  a===b     a model edge: both halves stay one, the spokes are none
//   \ /
//    d
TEST(EditMesh, HalvesOfAModelEdgeAreModelEdges) {
  EditMesh m({{0, 1, 2}, {1, 0, 3}}, 4, {1, 1});
  const int v = m.split(0);
  int model = 0, spokes = 0;
  m.star(v, [&](int h) { (m.hard[h] ? model : spokes) += 1; });
  EXPECT_EQ(model, 2);
  EXPECT_EQ(spokes, 2);
}

}  // namespace
