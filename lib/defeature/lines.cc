// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>

#include "lib/core/union_find.h"
#include "lib/defeature/zipper.h"

namespace meshpipe {
namespace {
constexpr double corner_turn = 50 * std::numbers::pi / 180;  ///< as mfeature counts corners
}

bool MergedSurface::is_corner(int v) const {
  Vec3 along[2];
  int count = 0;
  auto see = [&](int w) {
    if (count < 2) along[count] = points[w] - points[v];
    ++count;
  };
  mesh.star(v, [&](int h) {
    if (mesh.hard[h]) see(mesh.to(h));
    if (mesh.opp[prev(h)] < 0) see(mesh.apex(h));
  });
  return count == 1 || count > 2 || (count == 2 && angle(-1.0 * along[0], along[1]) > corner_turn);
}

double MergedSurface::sharpest(int v) const {
  auto is_line = [&](int h) { return mesh.opp[h] < 0 || is_model(h); };
  int first = -1;
  mesh.star(v, [&](int h) {
    if (first < 0 && is_line(h)) first = h;
  });
  double least = std::numbers::pi, sum = 0;
  if (first < 0) return least;
  for (int h = first;;) {
    sum += angle(points[mesh.to(h)] - points[v], points[mesh.apex(h)] - points[v]);
    if (is_line(prev(h))) least = std::min(least, sum), sum = 0;
    h = mesh.opp[prev(h)];
    if (h < 0 || h == first) return least;
  }
}

FeatureLines find_lines(const EditMesh& mesh, const Surface& surface, const std::vector<int>* given,
                        const std::vector<char>& wrinkles) {
  const int n = (int)mesh.opp.size(), n_vertices = (int)surface.points.size();
  std::vector<int> count(n_vertices, 0);
  std::vector<std::array<int, 2>> at(n_vertices);  // the first two edges
  std::vector<int> edges;                          // their first half-edges
  auto end = [&](int v) {
    if (count[v] < 2) at[v][count[v]] = (int)edges.size();
    ++count[v];
  };
  for (int h = 0; h < n; ++h)
    if (mesh.hard[h] && mesh.opp[h] < h) end(mesh.from(h)), end(mesh.to(h)), edges.push_back(h);
  auto away = [&](int h, int v) {
    const Vec3 d = surface.points[mesh.to(h)] - surface.points[mesh.from(h)];
    return mesh.from(h) == v ? d : -1.0 * d;
  };
  UnionFind sets(edges.size());
  std::vector<char> node(n_vertices, 0);
  for (int v = 0; v < n_vertices; ++v) {
    const auto& [first, second] = at[v];
    node[v] = count[v] != 2 || angle(-1.0 * away(edges[first], v), away(edges[second], v)) > corner_turn;
    if (!node[v]) sets.join(first, second);
  }
  FeatureLines lines;
  lines.of.assign(n, -1), lines.seam = lines.of;
  lines.given = given ? *given : lines.of;
  std::vector<int> number(edges.size(), -1);
  const std::vector<int>* patch = surface.face.has("patch") ? &surface.face.get<int>("patch") : nullptr;
  for (int e = 0; e < (int)edges.size(); ++e) {
    const int h = edges[e], o = mesh.opp[h];
    int& l = number[sets.find(e)];
    if (l < 0) {
      l = (int)lines.length.size();
      lines.length.push_back(0), lines.open.push_back(0), lines.rank.push_back(0);
    }
    lines.of[h] = l;
    if (o >= 0) lines.of[o] = l;
    lines.length[l] += norm(away(h, mesh.from(h)));
    if (node[mesh.from(h)] || node[mesh.to(h)]) lines.open[l] = 1;
    const bool strong = o >= 0 && (lines.given[h] >= 0 || (patch && (*patch)[h / 3] != (*patch)[o / 3]));
    lines.rank[l] = std::max<char>(lines.rank[l], o < 0 ? 3 : strong ? 2 : wrinkles[h] ? 0 : 1);
  }
  return lines;
}

}  // namespace meshpipe
