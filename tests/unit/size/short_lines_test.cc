// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/size/local_feature_size.h"

using namespace meshpipe;

TEST(JunctionLines, ShortOnesLowerTheSize) {
  // three fins on a line of two edges, 0.1 and 0.2 long
  Mesh mesh{{{0, 0, 0}, {0.1, 0, 0}, {0.3, 0, 0}, {0, 1, 0}, {0, -1, 1}, {0, -1, -1}}, {}};
  for (int apex : {3, 4, 5})
    for (int v : {0, 1}) mesh.tris.push_back({v, v + 1, apex});
  std::vector<double> size(6, 1.0);
  lower_along_short_lines(mesh, size);
  for (int v : {0, 1, 2}) EXPECT_NEAR(size[v], 0.45, 1e-12);
  for (int v : {3, 4, 5}) EXPECT_EQ(size[v], 1);
  size.assign(6, 0.4);
  lower_along_short_lines(mesh, size);
  EXPECT_EQ(size, std::vector<double>(6, 0.4));
}
