// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/aggregates.h"

#include <numeric>

#include "lib/core/lists.h"

namespace meshpipe {

Aggregates grow_aggregates(const Connectivity& mesh, const std::vector<double>& area, int wanted) {
  const std::vector<int>& opposite = mesh.opposite;
  const int n = (int)area.size();
  Aggregates result;
  if (wanted >= n) {
    result.n = n;
    result.of = identity(n);
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
  // by their second aggregate, then by their first
  const Lists by_second = lists_of(result.n, [&](auto use) {
    for (int h = 0; h < 3 * n; ++h)
      if (int o = opposite[h]; o >= 0 && result.of[h / 3] < result.of[o / 3]) use(result.of[o / 3], h);
  });
  auto by_first = [&](auto use) {
    for (int h : by_second.row) use(result.of[h / 3], h);
  };
  result.crossing = lists_of(result.n, by_first).row;
  return result;
}

}  // namespace meshpipe
