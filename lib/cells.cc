// SPDX-License-Identifier: BSD-3-Clause
#include "lib/cells.h"

#include <algorithm>
#include <numeric>

namespace meshpipe {

Cells grow_cells(const std::vector<int>& opposite, const std::vector<double>& area, int wanted) {
  const int n = (int)area.size();
  Cells cells;
  if (wanted >= n) {
    cells.n = n;
    cells.of.resize(n);
    std::iota(cells.of.begin(), cells.of.end(), 0);
  } else {
    const double share = std::accumulate(area.begin(), area.end(), 0.0) / wanted, least = 0.3 * share;
    cells.of.assign(n, -1);
    std::vector<double> size;
    std::vector<int> front, seeds{0};
    std::size_t next_seed = 0;
    for (int t = 0; t < n;) {
      // next to the cells there are, so that few gaps are left
      while (next_seed < seeds.size() && cells.of[seeds[next_seed]] >= 0) ++next_seed;
      if (next_seed == seeds.size()) {
        while (t < n && cells.of[t] >= 0) ++t;
        if (t == n) break;
        seeds.push_back(t);
      }
      front.assign(1, seeds[next_seed]);
      cells.of[front[0]] = cells.n;
      double grown = 0;
      std::size_t at = 0;
      for (; at < front.size() && grown < share; ++at) {
        grown += area[front[at]];
        for (int h = 3 * front[at]; h < 3 * front[at] + 3; ++h)
          if (int o = opposite[h]; o >= 0 && cells.of[o / 3] < 0) {
            cells.of[o / 3] = cells.n;
            front.push_back(o / 3);
          }
      }
      for (; at < front.size(); ++at) {
        cells.of[front[at]] = -1;
        seeds.push_back(front[at]);
      }
      size.push_back(grown);
      ++cells.n;
    }
    // what is left between the others joins one of them; the numbers close up
    for (bool again = true; again;) {
      again = false;
      for (int t = 0; t < n; ++t) {
        if (size[cells.of[t]] >= least) continue;
        for (int h = 3 * t; h < 3 * t + 3; ++h)
          if (int o = opposite[h]; o >= 0 && size[cells.of[o / 3]] >= least) {
            cells.of[t] = cells.of[o / 3];
            again = true;
            break;
          }
      }
    }
    std::vector<int> number(cells.n, -1);
    cells.n = 0;
    for (int& c : cells.of) {
      if (number[c] < 0) number[c] = cells.n++;
      c = number[c];
    }
  }
  // sorted in linear time: by the higher cell, then stably by the lower one
  std::vector<int> start(cells.n + 1), order;
  auto sort_by = [&](auto key) {
    std::fill(start.begin(), start.end(), 0);
    for (int h : cells.crossing) ++start[key(h) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    order.resize(cells.crossing.size());
    for (int h : cells.crossing) order[start[key(h)]++] = h;
    cells.crossing.swap(order);
  };
  for (int h = 0; h < 3 * n; ++h)
    if (int o = opposite[h]; o >= 0 && cells.of[h / 3] < cells.of[o / 3]) cells.crossing.push_back(h);
  sort_by([&](int h) { return cells.of[opposite[h] / 3]; });
  sort_by([&](int h) { return cells.of[h / 3]; });
  return cells;
}

}  // namespace meshpipe
