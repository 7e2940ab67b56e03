// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/neighborhood.h"

#include <algorithm>

#include "lib/core/lists.h"
#include "lib/core/parallel.h"
#include "lib/core/take_rows.h"

namespace meshpipe {
namespace {

/// Writes the first rows of `part` into the listed rows of `whole`, and appends the others.
void put_rows(const Table& part, const std::vector<int>& rows, Table& whole) {
  for (const Column& c : part.columns)
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
          std::vector<T>& all = whole.get<T>(c.name);
          for (std::size_t i = 0; i < rows.size(); ++i) all[rows[i]] = values[i];
          all.insert(all.end(), values.begin() + (std::ptrdiff_t)rows.size(), values.end());
        },
        c.data);
  whole.rows += part.rows - rows.size();
}

/// As take_faces; `number`: -1 for every vertex, before and after the call.
SurfacePart take_faces(const Surface& whole, std::vector<int> faces, std::vector<int>& number) {
  SurfacePart part;
  part.face = std::move(faces);
  for (int t : part.face)
    for (int v : whole.tris[t]) {
      if (number[v] < 0) part.vertex.push_back(v);
      number[v] = 0;
    }
  std::sort(part.vertex.begin(), part.vertex.end());
  for (int v : part.vertex) {
    number[v] = (int)part.surface.points.size();
    part.surface.points.push_back(whole.points[v]);
  }
  part.surface.tris.reserve(part.face.size());
  for (int t : part.face) {
    const Tri& v = whole.tris[t];
    part.surface.tris.push_back({number[v[0]], number[v[1]], number[v[2]]});
  }
  part.surface.vertex = rows_of(whole.vertex, part.vertex);
  part.surface.face = rows_of(whole.face, part.face);
  for (int v : part.vertex) number[v] = -1;
  return part;
}

}  // namespace

SurfacePart take_faces(const Surface& whole, std::vector<int> faces) {
  std::vector<int> number(whole.points.size(), -1);
  return take_faces(whole, std::move(faces), number);
}

std::vector<Neighborhood> take_neighborhoods(const CutSurface& connected, const std::vector<int>& label,
                                             int n) {
  const Surface& whole = connected.surface;
  const std::vector<int>& opposite = connected.opposite;
  const Lists faces = lists_of(n, [&](auto use) {
    for (int t = 0; t < (int)label.size(); ++t)
      if (label[t] >= 0) use(label[t], t);
  });
  std::vector<int> place(whole.tris.size(), -1);
  for (int l = 0; l < n; ++l)
    for (int i = 0; i < (int)faces[l].size(); ++i) place[faces[l][i]] = i;
  std::vector<std::vector<int>> number(omp_get_max_threads());
  std::vector<Neighborhood> parts(n);
  parallel_for(n, [&](int l) {
    std::vector<int>& mine = number[thread_of_loop(n)];
    mine.resize(whole.points.size(), -1);
    Neighborhood& near = parts[l];
    static_cast<SurfacePart&>(near) = take_faces(whole, {faces[l].begin(), faces[l].end()}, mine);
    if (opposite.empty()) return;
    near.opposite.reserve(3 * near.face.size());
    for (int t : near.face)
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = opposite[h];
        const bool within = o >= 0 && label[o / 3] == l;
        near.opposite.push_back(within ? 3 * place[o / 3] + o % 3 : -1);
        if (o >= 0 && !within) near.rim.push_back({origin(whole.tris, h), target(whole.tris, h), h});
      }
    std::sort(near.rim.begin(), near.rim.end());
  });
  return parts;
}

Neighborhood take_neighborhood(const CutSurface& connected, const std::vector<int>& label, int part) {
  const Surface& whole = connected.surface;
  const int n = (int)whole.tris.size();
  std::vector<char> within(whole.points.size(), 0);
  for (int t = 0; t < n; ++t)
    if (label[t] == part)
      for (int v : whole.tris[t]) within[v] = 1;
  std::vector<int> taken(n, -1);
  for (int t = 0; t < n; ++t)
    if (const Tri& v = whole.tris[t]; within[v[0]] + within[v[1]] + within[v[2]] >= 2) taken[t] = 0;
  return std::move(take_neighborhoods(connected, taken, 1)[0]);
}

void put_back(const Neighborhood& part, const CutSurface& connected) {
  Surface& whole = connected.surface;
  std::vector<int>& opposite = connected.opposite;
  const int taken = (int)part.face.size(), first = (int)whole.tris.size(),
            first_point = (int)whole.points.size();
  const int known = (int)part.vertex.size();
  auto vertex = [&](int v) { return v < known ? part.vertex[v] : first_point + v - known; };
  auto face = [&](int t) { return t < taken ? part.face[t] : first + t - taken; };
  auto half_edge = [&](int h) { return 3 * face(h / 3) + h % 3; };
  const Surface& s = part.surface;
  whole.points.insert(whole.points.end(), s.points.begin() + known, s.points.end());
  put_rows(s.vertex, part.vertex, whole.vertex);
  put_rows(s.face, part.face, whole.face);
  whole.tris.resize(first + s.tris.size() - taken);
  for (int t = 0; t < (int)s.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) whole.tris[face(t)][i] = vertex(s.tris[t][i]);
  if (opposite.empty()) return;
  std::vector<Neighborhood::Rim> rim = part.rim;
  for (Neighborhood::Rim& r : rim) r.half_edge = opposite[r.half_edge];
  opposite.resize(3 * whole.tris.size());
  for (int h = 0; h < (int)part.opposite.size(); ++h) {
    const int o = part.opposite[h], here = half_edge(h);
    opposite[here] = o < 0 ? -1 : half_edge(o);
    if (o >= 0) continue;
    const Neighborhood::Rim edge{origin(whole.tris, here), target(whole.tris, here), -1};
    const auto beyond = std::lower_bound(rim.begin(), rim.end(), edge);
    if (beyond == rim.end() || beyond->from != edge.from || beyond->to != edge.to) continue;
    opposite[here] = beyond->half_edge;
    opposite[beyond->half_edge] = here;
  }
}

}  // namespace meshpipe
