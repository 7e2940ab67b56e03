// SPDX-License-Identifier: BSD-3-Clause
#include "lib/weld.h"

#include <algorithm>
#include <numeric>

namespace meshpipe {

void weld(Mesh& mesh) {
  const int n = (int)mesh.points.size();
  std::vector<int> order(n), to(n, -1);
  std::iota(order.begin(), order.end(), 0);
  auto key = [&](int v) { return std::array{mesh.points[v].x, mesh.points[v].y, mesh.points[v].z}; };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  std::vector<int> same(n);
  for (int i = 0; i < n; ++i)
    same[order[i]] = i && key(order[i]) == key(order[i - 1]) ? same[order[i - 1]] : order[i];
  std::vector<Vec3> points;
  for (Tri& t : mesh.tris)
    for (int& v : t) {
      int& number = to[same[v]];
      if (number < 0) {
        number = (int)points.size();
        points.push_back(mesh.points[v]);
      }
      v = number;
    }
  mesh.points = std::move(points);
}

}  // namespace meshpipe
