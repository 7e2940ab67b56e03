// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

using namespace meshpipe;

namespace {

// w x h squares, neighbors across edges; the edges between columns `weak` - 1 and `weak` weigh 1, all others
// 100
Graph grid(int w, int h, int weak = -1) {
  Graph g;
  g.start.push_back(0);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      auto edge = [&](int nx, int ny) {
        if (nx < 0 || nx >= w || ny < 0 || ny >= h) return;
        g.adjacency.push_back(ny * w + nx);
        g.edge_weight.push_back(std::max(x, nx) == weak && ny == y ? 1 : 100);
      };
      edge(x - 1, y), edge(x + 1, y), edge(x, y - 1), edge(x, y + 1);
      g.start.push_back((int)g.adjacency.size());
      g.vertex_weight.push_back(1);
    }
  return g;
}

}  // namespace

TEST(Graph, GivesEveryPartAboutItsShare) {
  auto part = partition_graph(grid(20, 20), 4, 0.1, 1);
  for (int p = 0; p < 4; ++p) EXPECT_NEAR(std::count(part.begin(), part.end(), p), 100, 25);
}

//  ....|.......   a loose balance lets the cut follow the weak edges, for some of the seeds
TEST(Graph, PrefersLightEdges) {
  int found = 0;
  for (int seed = 1; seed <= 4; ++seed) {
    auto part = partition_graph(grid(12, 5, 4), 2, 0.4, seed);
    bool along = true;
    for (int v = 0; v < 60; ++v) along = along && (part[v] == part[0]) == (v % 12 < 4);
    found += along;
  }
  EXPECT_GE(found, 1);
}

TEST(Graph, IsTheSameWhateverRandWasUsedForBefore) {
  std::srand(5);
  auto a = partition_graph(grid(30, 30), 3, 0.2, 7);
  std::rand();
  EXPECT_EQ(partition_graph(grid(30, 30), 3, 0.2, 7), a);
  partition_graph(grid(10, 10), 2, 0.2, 3);
  EXPECT_EQ(partition_graph(grid(30, 30), 3, 0.2, 7), a);
}

TEST(Graph, TakesTheSmallestGraphs) {
  EXPECT_TRUE(partition_graph({{0}, {}, {}, {}}, 2, 0.1, 1).empty());
  EXPECT_EQ(partition_graph(grid(2, 1), 2, 0.1, 1), (std::vector<int>{0, 1}));
  EXPECT_EQ(partition_graph(grid(3, 1), 1, 0.1, 1), (std::vector<int>{0, 0, 0}));
  EXPECT_THROW(partition_graph({{0, 1}, {1}, {}, {1}}, 2, 0.1, 1), std::logic_error);
}
