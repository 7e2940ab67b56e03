// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/gts.h"

#include "formats/text.h"
#include "lib/core/edges.h"

namespace meshpipe {

std::string write_gts(const Stream& stream, bool) {
  const Surface& s = stream.surface;
  std::vector<std::array<long long, 2>> edges;
  std::vector<long long> edge_of(3 * s.tris.size());  // by half-edge, from 1 on
  for_each_edge(s.tris, static_cast<int>(s.points.size()), [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]);
    edges.push_back({origin(s.tris, h) + 1LL, target(s.tris, h) + 1LL});
    for (EdgeUse e : uses) edge_of[half_edge(e)] = static_cast<long long>(edges.size());
  });
  std::string out;
  out.reserve(s.points.size() * 60 + s.tris.size() * 48);
  auto row = [&](std::initializer_list<long long> values) {
    for (long long v : values) {
      append(out, v);
      out += ' ';
    }
    out.back() = '\n';
  };
  row({static_cast<long long>(s.points.size()), static_cast<long long>(edges.size()),
       static_cast<long long>(s.tris.size())});
  out.back() = ' ';
  out += "GtsSurface GtsFace GtsEdge GtsVertex\n";
  for (const Vec3& p : s.points) append_point(out, "", p);
  for (const auto& [a, b] : edges) row({a, b});
  for (std::size_t t = 0; t < s.tris.size(); ++t)
    row({edge_of[3 * t], edge_of[3 * t + 1], edge_of[3 * t + 2]});
  return out;
}

}  // namespace meshpipe
