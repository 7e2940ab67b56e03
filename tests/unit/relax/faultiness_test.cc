// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/faultiness.h"

#include <gtest/gtest.h>

#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

/// A flat sheet of four triangles around e, and this many more above it, each `gap` over the last.
Surface sheets(int more, double gap) {
  Surface s = drawn_surface({"d       c",  //
                             "         ",  //
                             "    e    ",  //
                             "         ",  //
                             "a       b"},
                            "abe bce cde dae");
  for (int i = 1; i <= more; ++i) {
    for (int v = 0; v < 5; ++v) s.points.push_back(s.points[v] + Vec3{0, 0, i * gap});
    for (int t = 0; t < 4; ++t)
      s.tris.push_back({s.tris[t][0] + 5 * i, s.tris[t][1] + 5 * i, s.tris[t][2] + 5 * i});
  }
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  s.vertex.set("size", std::vector<double>(s.points.size(), 4));
  s.face.set("model", std::vector<std::uint8_t>(s.tris.size(), 0));
  return s;
}

Surroundings around(const State& s, const std::vector<int>& triangles) {
  MeshTree tree;
  tree.renew(s);
  return surroundings(s, tree, triangles, 4);
}

TEST(Surroundings, AreWhatIsNearAndNotOfThePatch) {
  Drawn near(sheets(1, 0.2));
  EXPECT_EQ(around(near.s, {3, 0, 2, 1}).mesh.tris.size(), 4u);
  EXPECT_EQ(around(near.s, {0}).mesh.tris.size(), 7u);
  Drawn far(sheets(1, 2));
  EXPECT_TRUE(around(far.s, {0, 1, 2, 3}).box.empty());
}

TEST(Surroundings, TooManyAreNotLookedAt) {
  Drawn m(sheets(75, 0.01));
  EXPECT_EQ(around(m.s, {0, 1, 2, 3}).box.size(), 300u);
  Drawn more(sheets(76, 0.01));
  EXPECT_TRUE(around(more.s, {0, 1, 2, 3}).box.empty());
}

// e rises through the sheet above
TEST(Faultiness, PairsWithTheSurroundingsCount) {
  Drawn m(sheets(1, 0.2));
  const std::vector<int> triangles{0, 1, 2, 3};
  Samples samples{feature_samples(m.reference, 10), {}};
  Known known{m.reference.surface, samples};
  State patch = extract(m.s, triangles);
  PatchBefore alone, before{around(m.s, triangles)};
  EXPECT_EQ(with_faultiness(patch, 0, infinity, {}, 4, known, before), 0);
  EXPECT_EQ(with_faultiness(patch, 0, infinity, {}, 4, known, alone), 0);
  patch.points[4].z = 0.4;
  EXPECT_GT(with_faultiness(patch, 0, infinity, {}, 4, known, before),
            with_faultiness(patch, 0, infinity, {}, 4, known, alone));
  const double all = with_faultiness(patch, 0, infinity, {}, 4, known, before);
  EXPECT_EQ(with_faultiness(patch, 0, all, {}, 4, known, before), all);
  const double some = with_faultiness(patch, 0, 0, {}, 4, known, before);
  EXPECT_GT(some, 0);
  EXPECT_LT(some, all);
}

}  // namespace
