// SPDX-License-Identifier: BSD-3-Clause
// Vertices that go to where the reference bends.
#include <gtest/gtest.h>

#include "lib/relax/faults.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

TEST(Bends, ANewVertexGoesToTheRidgeThatAnEdgePasses) {
  const Surface reference = roof(2);
  Surface across = reference;
  across.tris = {{0, 1, 2}, {1, 0, 3}};
  Drawn m(reference, &across);
  put_at_corners(m, reference);
  const int ab = m.edge('a', 'b');
  int found = 0;
  for (const Edit& e : edits_to_bends(m.s, 0)) {
    const Vec3 p = m.reference.walk.point(e.place);
    EXPECT_EQ(e.kind, Edit::reach);
    EXPECT_NEAR(p.y, 1, 1e-12);
    EXPECT_NEAR(p.z, 0, 1e-12);
    if (e.h != ab || e.end >= 0 || std::abs(p.x - 4) > 1e-9) continue;
    ++found;
    State s = m.s;
    ASSERT_TRUE(reach(s, e));
    EXPECT_EQ(s.mesh.live, 4);
    EXPECT_EQ(s.hold.back(), anchored);
    EXPECT_NEAR(norm(s.points.back() - Vec3{4, 1, 0}), 0, 1e-9);
  }
  EXPECT_EQ(found, 1);
}

TEST(Bends, AFlatReferenceHasNone) {
  const Surface flat = roof(0);
  Drawn m(flat);
  EXPECT_TRUE(edits_to_bends(m.s, 0).empty());
}

// two roofs that share no edge: no walk leads from one to the other
TEST(Bends, AVertexThatCannotWalkThereStays) {
  Surface two = roof(2);
  for (int v = 0; v < 4; ++v) two.points.push_back(two.points[v] + Vec3{20, 0, 0});
  two.tris.insert(two.tris.end(), {{4, 7, 6}, {5, 6, 7}});
  two.vertex.rows = 8, two.face.rows = 4;
  two.vertex.set("size", std::vector<double>(8, 4));
  two.face.set("model", std::vector<std::uint8_t>(4, 0));
  Drawn m(two);
  Edit e{Edit::reach, m.edge('a', 'd'), 0};
  e.place = {2, 0, 0.5, 0.5};  // on the ridge of the other
  const std::vector<Vec3> before = m.s.points;
  EXPECT_FALSE(reach(m.s, e));
  EXPECT_EQ(m.s.points, before);
  e.place.face = 0;
  EXPECT_TRUE(reach(m.s, e));
  EXPECT_NEAR(m.s.points[0].z, 0, 1e-12);
}

// the upper of two roofs a twentieth of the size apart has its chord a-b below the ridge of the lower one
TEST(Bends, SheetsNearerThanChordsSagArePartedThere) {
  const Surface upper = roof(1);
  Surface reference = upper, mesh = upper;
  mesh.tris = {{0, 1, 2}, {1, 0, 3}};
  for (Surface* s : {&reference, &mesh}) {
    for (Vec3 p : upper.points) s->points.push_back(p - Vec3{0, 0, 0.2});
    for (const Tri& t : upper.tris) s->tris.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    s->vertex.rows = 8, s->face.rows = 4;
    s->vertex.set("size", std::vector<double>(8, 4));
    s->face.set("model", std::vector<std::uint8_t>(4, 0));
  }
  Drawn m(reference, &mesh);
  put_at_corners(m, reference);
  Samples samples{feature_samples(m.reference, 10), {}};
  Known known{m.reference.surface, samples};
  ASSERT_FALSE(find_faults(m.s, known).pairs.empty());
  EXPECT_TRUE(remove_faults(m.s, samples).pairs.empty());
}

}  // namespace
