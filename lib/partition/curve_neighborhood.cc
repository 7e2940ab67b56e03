// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/curve_neighborhood.h"

#include <algorithm>
#include <limits>

#include "lib/core/lists.h"
#include "lib/core/regions.h"

namespace meshpipe {
namespace {

int index_in(const std::vector<int>& sorted, int value) {
  return int(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
}

/// Labels the connected sets of triangles within some rings of curves; -1: the others. Returns the number of
/// sets.
int label_near(const CutSurface& cut, const std::vector<Curve>& curves, int rings, std::vector<int>& label) {
  const std::vector<Tri>& tris = cut.surface.tris;
  std::vector<int> reached(cut.surface.points.size(), -1), leaving;
  for (const Curve& c : curves)
    for (int h : c.half_edges) {
      reached[origin(tris, h)] = reached[target(tris, h)] = 0;
      leaving.insert(leaving.end(), {h, next(h)});
    }
  grow_owners(cut.connectivity(), std::move(leaving), rings, reached, [](int, int) { return true; });
  constexpr int near = -2, far = -1;
  label.assign(tris.size(), far);
  for (std::size_t t = 0; t < tris.size(); ++t)
    for (int v : tris[t])
      if (reached[v] >= 0) label[t] = near;
  int n = 0;
  std::vector<int> stack;
  for (int first = 0; first < (int)tris.size(); ++first) {
    if (label[first] != near) continue;
    label[first] = n;
    stack.push_back(first);
    while (!stack.empty()) {
      const int t = take_last(stack);
      for (int h = 3 * t; h < 3 * t + 3; ++h)
        if (const int o = cut.opposite[h]; o >= 0 && label[o / 3] == near) {
          label[o / 3] = n;
          stack.push_back(o / 3);
        }
    }
    ++n;
  }
  return n;
}

/// Sets what is allowed: what parts have, and an equal share of what they may still get.
void allow_faces(const std::vector<int>& part, int max_faces, std::vector<CurveNeighborhood>& sets) {
  std::vector<int> left(1 + *std::max_element(part.begin(), part.end()), max_faces), sharing(left.size(), 0);
  for (int p : part) --left[p];
  for (const CurveNeighborhood& s : sets)
    for (int p : s.parts) ++sharing[p];
  for (CurveNeighborhood& s : sets) {
    for (int i = 0; i < s.n_parts(); ++i) s.allowed[i] = std::max(0, left[s.parts[i]]) / sharing[s.parts[i]];
    for (int p : s.surface.face.get<int>("part")) ++s.allowed[p];
  }
}

}  // namespace

std::vector<CurveNeighborhood> take_curve_neighborhoods(const CutSurface& cut,
                                                        const std::vector<Curve>& curves, int rings,
                                                        int max_faces) {
  std::vector<int> label;
  const int n = label_near(cut, curves, rings, label);
  std::vector<Neighborhood> near = take_neighborhoods(cut, label, n);
  std::vector<CurveNeighborhood> sets(n);
  const std::vector<int>& part = cut.surface.face.get<int>("part");
  for (int i = 0; i < n; ++i) {
    CurveNeighborhood& s = sets[i];
    static_cast<Neighborhood&>(s) = std::move(near[i]);
    for (int h = 0; h < (int)s.opposite.size(); ++h) {
      const int o = s.opposite[h] >= 0 ? -1 : cut.opposite[3 * s.face[h / 3] + h % 3];
      if (o >= 0 && part[o / 3] == part[s.face[h / 3]]) s.anchors.push_back(h);
    }
    std::vector<int>& here = s.surface.face.get<int>("part");
    s.parts = here;
    sort_unique(s.parts);
    for (int& p : here) p = index_in(s.parts, p);
    s.allowed.assign(s.parts.size(), std::numeric_limits<int>::max());
  }
  if (max_faces > 0) allow_faces(part, max_faces, sets);
  for (const Curve& c : curves) {
    CurveNeighborhood& s = sets[label[c.half_edges[0] / 3]];
    const auto [a, b] = handle_of(cut.surface, c);
    s.handles.push_back({index_in(s.vertex, a), index_in(s.vertex, b)});
  }
  for (CurveNeighborhood& s : sets) std::sort(s.handles.begin(), s.handles.end());
  return sets;
}

void put_back(CurveNeighborhood near, const CutSurface& cut) {
  for (int& p : near.surface.face.get<int>("part")) p = near.parts[p];
  put_back(static_cast<const Neighborhood&>(near), cut);
}

PartTopologies topology_of_parts_in(const CurveNeighborhood& near, const Connectivity& mesh,
                                    const std::vector<int>& part) {
  PartTopologies r{part, std::vector<PartTopology>(near.n_parts()), {}};
  std::vector<char> seen(separate_pieces(mesh, r.piece), 0);
  for (std::size_t t = 0; t < part.size(); ++t)
    if (!seen[r.piece[t]]) seen[r.piece[t]] = 1, ++r.part[part[t]].pieces;
  const Regions regions = find_regions(mesh, part, near.n_parts());
  for (int p = 0; p < near.n_parts(); ++p) {
    PartTopology& t = r.part[p];
    t.faces = regions.region[p].faces;
    t.genus = regions.region[p].genus() + t.pieces - 1;
    std::vector<int> v;
    for (int h : regions.border[p]) v.push_back(mesh.from(h));
    sort_unique(v);
    t.pinches = int(regions.border[p].size() - v.size());
  }
  for (int h : near.anchors) {
    auto same_part = [&](int t) { return part[t] == part[h / 3]; };
    int g = h;
    do g = next_on_border(mesh.opposite, g, same_part);
    while (mesh.opposite[g] >= 0 || !std::binary_search(near.anchors.begin(), near.anchors.end(), g));
    r.next.push_back(g);
  }
  return r;
}

std::vector<char> broken_parts(const PartTopologies& before, const PartTopologies& now,
                               const std::vector<int>& part, const CurveNeighborhood& near) {
  std::vector<char> broken(near.n_parts(), 0);
  std::vector<int> becomes(before.piece.size(), -1), was(now.piece.size(), -1), attached(near.n_parts(), 0);
  for (std::size_t i = 0; i < near.anchors.size(); ++i) {
    const int t = near.anchors[i] / 3, a = before.piece[t], b = now.piece[t];
    if (becomes[a] < 0) becomes[a] = b, ++attached[part[t]];
    if (was[b] < 0) was[b] = a;
    broken[part[t]] |= becomes[a] != b || was[b] != a || before.next[i] != now.next[i];
  }
  for (int p = 0; p < near.n_parts(); ++p) {
    const PartTopology &x = before.part[p], &y = now.part[p];
    broken[p] |= y.pieces != std::max(1, attached[p]) || y.genus != x.genus || y.pinches > x.pinches ||
                 y.faces > near.allowed[p];
  }
  return broken;
}

}  // namespace meshpipe
