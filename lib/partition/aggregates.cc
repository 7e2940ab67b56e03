// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/aggregates.h"

#include <algorithm>
#include <numeric>

namespace meshpipe {

Aggregates grow_aggregates(const Connectivity& mesh, const std::vector<double>& area, int wanted) {
  const std::vector<int>& opposite = mesh.opposite;
  const int n = (int)area.size();
  Aggregates result;
  if (wanted >= n) {
    result.n = n;
    result.of.resize(n);
    std::iota(result.of.begin(), result.of.end(), 0);
  } else {
    const double share = std::accumulate(area.begin(), area.end(), 0.0) / wanted, least = 0.3 * share;
    result.of.assign(n, -1);
    std::vector<double> size;
    std::vector<int> front, seeds{0};
    std::size_t next_seed = 0;
    for (int t = 0; t < n;) {
      // next to the aggregates there are, so that few gaps are left
      while (next_seed < seeds.size() && result.of[seeds[next_seed]] >= 0) ++next_seed;
      if (next_seed == seeds.size()) {
        while (t < n && result.of[t] >= 0) ++t;
        if (t == n) break;
        seeds.push_back(t);
      }
      front.assign(1, seeds[next_seed]);
      result.of[front[0]] = result.n;
      double grown = 0;
      std::size_t at = 0;
      for (; at < front.size() && grown < share; ++at) {
        grown += area[front[at]];
        for (int h = 3 * front[at]; h < 3 * front[at] + 3; ++h)
          if (int o = opposite[h]; o >= 0 && result.of[o / 3] < 0) {
            result.of[o / 3] = result.n;
            front.push_back(o / 3);
          }
      }
      for (; at < front.size(); ++at) {
        result.of[front[at]] = -1;
        seeds.push_back(front[at]);
      }
      size.push_back(grown);
      ++result.n;
    }
    // what is left between the others joins one of them; the numbers close up
    for (bool again = true; again;) {
      again = false;
      for (int t = 0; t < n; ++t) {
        if (size[result.of[t]] >= least) continue;
        for (int h = 3 * t; h < 3 * t + 3; ++h)
          if (int o = opposite[h]; o >= 0 && size[result.of[o / 3]] >= least) {
            result.of[t] = result.of[o / 3];
            again = true;
            break;
          }
      }
    }
    std::vector<int> number(result.n, -1);
    result.n = 0;
    for (int& c : result.of) {
      if (number[c] < 0) number[c] = result.n++;
      c = number[c];
    }
  }
  // sorted in linear time: by the higher aggregate, then stably by the lower one
  std::vector<int> start(result.n + 1), order;
  auto sort_by = [&](auto key) {
    std::fill(start.begin(), start.end(), 0);
    for (int h : result.crossing) ++start[key(h) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    order.resize(result.crossing.size());
    for (int h : result.crossing) order[start[key(h)]++] = h;
    result.crossing.swap(order);
  };
  for (int h = 0; h < 3 * n; ++h)
    if (int o = opposite[h]; o >= 0 && result.of[h / 3] < result.of[o / 3]) result.crossing.push_back(h);
  sort_by([&](int h) { return result.of[opposite[h] / 3]; });
  sort_by([&](int h) { return result.of[h / 3]; });
  return result;
}

}  // namespace meshpipe
