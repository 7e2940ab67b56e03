// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/shortest_paths.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace meshpipe;

// a ring of n nodes with edges of length 1, except one of length 10 between n - 1 and 0
static auto ring(int n, std::vector<double>& distance, std::vector<int>& order) {
  return [n, &distance, &order](int v, auto reach) {
    order.push_back(v);
    reach((v + 1) % n, distance[v] + (v == n - 1 ? 10 : 1));
    reach((v + n - 1) % n, distance[v] + (v == 0 ? 10 : 1));
  };
}

TEST(ShortestPaths, VisitsNodesOnceInOrder) {
  std::vector<double> distance(6, HUGE_VAL);
  std::vector<int> order;
  distance[2] = 0;
  shortest_paths({2}, distance, ring(6, distance, order));
  EXPECT_EQ(distance, (std::vector<double>{2, 1, 0, 1, 2, 3}));
  EXPECT_EQ(order, (std::vector<int>{2, 1, 3, 0, 4, 5}));
}

TEST(ShortestPaths, SourcesMayStartWithOffsets) {
  std::vector<double> distance(6, HUGE_VAL);
  std::vector<int> order;
  distance[0] = 5, distance[5] = 0.5;
  shortest_paths({0, 5}, distance, ring(6, distance, order));
  EXPECT_EQ(distance, (std::vector<double>{5, 4.5, 3.5, 2.5, 1.5, 0.5}));
}

TEST(ShortestPaths, EndsWhereVisitSaysSo) {
  std::vector<double> distance(6, HUGE_VAL);
  distance[0] = 0;
  int visited = 0;
  shortest_paths({0}, distance, [&](int v, auto reach) {
    reach((v + 1) % 6, distance[v] + 1);
    return ++visited < 3;
  });
  EXPECT_EQ(visited, 3);
  EXPECT_EQ(distance[3], 3);
  EXPECT_EQ(distance[4], HUGE_VAL);
}
