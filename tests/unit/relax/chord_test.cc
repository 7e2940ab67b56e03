// SPDX-License-Identifier: BSD-3-Clause
// Chords: edges that join two vertices of the rim of a plane patch from outside of it.
#include <gtest/gtest.h>

#include "lib/relax/faults.h"
#include "lib/relax/operations.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

/// A tube with a rhombus a b c d for a section, sharp at b and d, a cap with the edge b d on it, and an open
/// end e f h g below b a d c. The surface next to b has the edge b e.
Surface capped(Vec3 e = {3, 0, -2}) {
  Mesh mesh;
  mesh.points = {{0, -1, 0}, {3, 0, 0}, {0, 1, 0}, {-3, 0, 0}, e, {0, -1, -2}, {0, 1, -2}, {-3, 0, -2}};
  const char* const tris[] = {"abd", "bcd", "bae", "cbe", "afe", "ceg", "cgh", "chd", "dha", "ahf"};
  for (const char* t : tris) mesh.tris.push_back({t[0] - 'a', t[1] - 'a', t[2] - 'a'});
  Surface s = surface_of(mesh);
  s.vertex.set("size", std::vector<double>(8, 3));
  std::vector<std::uint8_t> bits(s.tris.size());
  bits[0] = 1 | 4, bits[1] = 1 | 2, bits[2] = 1, bits[3] = 1, bits[7] = 4, bits[8] = 4;
  s.face.set("model", bits);
  return s;
}

TEST(Chord, OfTheReferenceIsNoFault) {
  Surface s = capped();
  s.tris[2] = {'a' - 'a', 'e' - 'a', 'c' - 'a'};
  s.tris[3] = {'c' - 'a', 'b' - 'a', 'a' - 'a'};  // on the cap, with a chord
  auto& bits = s.face.get<std::uint8_t>("model");
  bits[2] = 0, bits[3] = 1 | 2;
  Drawn m(s);
  ASSERT_FALSE(chords_of(m.s).empty());
  Samples samples{feature_samples(m.reference, 3), {}};
  Known known{m.reference.surface, samples};
  const Fault found = find_faults(m.s, known);
  EXPECT_TRUE(found.pairs.empty());
  EXPECT_GT(found.of_reference, 0);
}

TEST(Chord, IsNotFlippedTo) {
  Drawn m(capped());
  EXPECT_FALSE(may_flip(m.s, m.edge('b', 'e')));  // to a c
  EXPECT_TRUE(may_flip(m.s, m.edge('b', 'd')));   // the same, but on the cap
}

TEST(Chord, IsNotCollapsedTo) {
  Drawn m(capped());
  insert_vertex(m.s, m.edge('b', 'e'), {3, 0, 0.5, 0.5}, {3, 0, -1}, {1, 0, 0});
  m.s.hold['e' - 'a'] = loose;
  const rules::Collapse any{1e30, 1e30, true};
  const int v = (int)m.s.points.size() - 1, h = m.edge('a', (char)('a' + v));
  EXPECT_FALSE(collapse_edge(m.s, h, v, any));  // joins a to c
  m.s.hold['c' - 'a'] = loose;                  // as if it were not on the rim
  EXPECT_TRUE(collapse_edge(m.s, h, v, any));
}

TEST(Chord, IsSplitOrFlippedAway) {
  Drawn m(capped());
  m.s.mesh.flip(m.edge('b', 'e'));
  const int chord = m.edge('a', 'c');
  ASSERT_NE(chord, -1);
  EXPECT_TRUE(starts_chord(m.s, chord, m.s.points['c' - 'a']));
  m.s.hold['e' - 'a'] = loose;
  split_chords(m.s);
  EXPECT_EQ(m.edge('a', 'c'), -1);
}

TEST(Chord, IsNotFlippedIntoANeedle) {
  Drawn m(capped({-4.5, 0, -1}));
  m.s.mesh.flip(m.edge('b', 'e'));
  m.s.hold['e' - 'a'] = loose;
  split_chords(m.s);
  EXPECT_EQ(m.edge('a', 'c'), -1);
  EXPECT_EQ(m.edge('b', 'e'), -1);
}

}  // namespace
