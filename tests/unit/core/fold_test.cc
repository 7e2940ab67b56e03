// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/fold.h"

#include <gtest/gtest.h>

using namespace meshpipe;

namespace {

const Vec3 up{0, 0, 1}, down{0, 0, -1}, a{0, 0, 0}, b{1, 0, 0};

/// A square around the edge a-b, and another one `below` it that faces down; none below 0.
Mesh squares(double below) {
  Mesh m{{{-2, -2, 0}, {3, -2, 0}, {3, 2, 0}, {-2, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  if (below < 0) return m;
  for (int v = 0; v < 4; ++v) m.points.push_back(m.points[v] - below * up);
  m.tris.insert(m.tris.end(), {{4, 6, 5}, {4, 7, 6}});
  return m;
}

TEST(Fold, TrianglesThatLieOnEachOtherTurnBack) {
  EXPECT_TRUE(turn_back(up, down));
  EXPECT_FALSE(turn_back(up, {1, 0, 0}));
}

TEST(Fold, ThinPlatesAreNone) {
  const Mesh sheet = squares(-1), thin = squares(0.5), thick = squares(1.5);
  EXPECT_TRUE(faces_one_way(a, b, up, down, sheet, Bvh(sheet)));
  EXPECT_FALSE(faces_one_way(a, b, up, down, thin, Bvh(thin)));
  EXPECT_TRUE(faces_one_way(a, b, up, down, thick, Bvh(thick)));
}

}  // namespace
