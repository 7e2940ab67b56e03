// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/union_find.h"

#include <gtest/gtest.h>

using namespace meshpipe;

TEST(UnionFind, JoinsUnderTheLowestName) {
  UnionFind sets(6);
  EXPECT_TRUE(sets.join(5, 3));
  EXPECT_TRUE(sets.join(4, 5));
  EXPECT_FALSE(sets.join(3, 4));
  EXPECT_EQ(sets.find(4), 3);
  EXPECT_EQ(sets.find(2), 2);
  EXPECT_TRUE(sets.join(0, 4));
  EXPECT_EQ(sets.find(5), 0);
}

TEST(UnionFind, MergesIntoTheNamedSet) {
  UnionFind sets(3);
  sets.merge_into(0, 2);
  EXPECT_EQ(sets.find(0), 2);
  sets.merge_into(2, 1);
  EXPECT_EQ(sets.find(0), 1);
}
