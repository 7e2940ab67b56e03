// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/clean/clean.h"

using namespace meshpipe;

TEST(Spikes, APointFarOutMovesAmongItsNeighbors) {
  Surface s;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) s.points.push_back({(double)i, (double)j, 0});
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      const int a = 6 * i + j;
      s.tris.push_back({a, a + 6, a + 7});
      s.tris.push_back({a, a + 7, a + 1});
    }
  s.face.rows = s.tris.size();
  const Vec3 place = s.points[14];
  EXPECT_EQ(find_spikes(s).count, 0);
  s.points[14].z = 12;  // its neighbors are within a box of 2 by 2
  EXPECT_EQ(find_spikes(s).count, 0);
  s.points[14].z = 20;
  EXPECT_EQ(find_spikes(s).count, 1);
  EXPECT_EQ(find_spikes(s).longest.z, 20);
  EXPECT_EQ(flatten_spikes(s, 5), 1);
  EXPECT_NEAR(norm(s.points[14] - place), 0, 1e-12);
  EXPECT_EQ(flatten_spikes(s, 5), 0);
}
