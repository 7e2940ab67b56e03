// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/junction_lines.h"

#include <algorithm>

#include "lib/core/connectivity.h"
#include "lib/core/edges.h"

namespace meshpipe {
namespace {

constexpr double per_length = 1.5;     // size over the length of a line: kappa 0.8 between such edges
constexpr double least_share = 0.001;  // of the size asked for: a shorter line is a point

}  // namespace

void lower_along_short_lines(const Mesh& mesh, std::vector<double>& size) {
  const int n = static_cast<int>(mesh.points.size());
  std::vector<std::array<int, 2>> edges;
  for_each_edge(mesh.tris, n, [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]);
    if (uses.size() > 2) edges.push_back({origin(mesh.tris, h), target(mesh.tris, h)});
  });
  std::vector<int> start(n + 1, 0);
  for (const auto& [a, b] : edges) ++start[a + 1], ++start[b + 1];
  for (int v = 0; v < n; ++v) start[v + 1] += start[v];
  std::vector<int> star(2 * edges.size()), at(start.begin(), start.end() - 1);
  for (int e = 0; e < static_cast<int>(edges.size()); ++e)
    for (int v : edges[e]) star[at[v]++] = e;
  const std::vector<double> asked = size;
  std::vector<int> line;
  for (int v = 0; v < n; ++v) {
    if (start[v + 1] - start[v] == 2) continue;
    for (int i = start[v]; i < start[v + 1]; ++i) {
      line.assign(1, v);
      double length = 0;
      for (int e = star[i];;) {
        const int w = edges[e][edges[e][0] == line.back()];
        length += norm(mesh.points[w] - mesh.points[line.back()]);
        line.push_back(w);
        if (start[w + 1] - start[w] != 2 || per_length * length >= asked[w]) break;
        e = star[start[w]] == e ? star[start[w] + 1] : star[start[w]];
      }
      if (start[line.back() + 1] - start[line.back()] == 2) continue;  // long enough
      for (int w : line) size[w] = std::min(size[w], std::max(per_length * length, least_share * asked[w]));
    }
  }
}

}  // namespace meshpipe
