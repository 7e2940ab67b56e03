// SPDX-License-Identifier: BSD-3-Clause
#include "lib/solids/solids.h"

#include <algorithm>

#include "lib/core/around.h"
#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"
#include "lib/core/edges.h"
#include "lib/core/largest_patch.h"
#include "lib/core/ray.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

/// Where a line along x passes through a triangle.
struct Crossing {
  double x;
  int triangle;
  int direction;  ///< sign of x of its normal
};

/// The crossings of the line through the centroid of triangle t, except with t, by x: those that lie ahead in
/// the given direction.
std::vector<Crossing> crossings(const Mesh& mesh, const Bvh& tree, int t, int ahead) {
  constexpr double far = 1e300;
  const Vec3 p = centroid(mesh, t);
  std::vector<Crossing> found;
  const Box line{{ahead > 0 ? p.x : -far, p.y, p.z}, {ahead > 0 ? far : p.x, p.y, p.z}};
  tree.overlapping(line, [&](int u) {
    const auto& [i, j, k] = mesh.tris[u];
    const Vec3 &a = mesh.points[i], &b = mesh.points[j], &c = mesh.points[k];
    if (u == t || !line_passes(p, a, b, c)) return;
    const int direction = orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z});
    if (orient3d(a, b, c, p) * direction != ahead) return;
    const Vec3 n = area_vector(a, b, c);
    found.push_back({a.x - (n.y * (p.y - a.y) + n.z * (p.z - a.z)) / n.x, u, direction});
  });
  std::sort(found.begin(), found.end(), [&](const Crossing& c, const Crossing& d) {
    return c.x != d.x ? ahead * c.x < ahead * d.x : c.triangle < d.triangle;
  });
  return found;
}

/// Sides of triangles, numbered as in lib/core/around.h; the last one is the outside.
struct Shells {
  UnionFind side, component;
};

Shells connect(const Mesh& mesh) {
  const int n = (int)mesh.tris.size();
  Shells s{UnionFind(2 * (std::size_t)n + 1), UnionFind(n)};
  const Around around(mesh.tris, [&](int t, int v) {
    const auto& [a, b, c] = mesh.tris[t];
    return -orient3d(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[v]);
  });
  std::vector<int> edge;
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    edge.clear();
    for (EdgeUse e : uses) edge.push_back(half_edge(e));
    for (int h : edge) s.component.join(h / 3, edge[0] / 3);
    if (edge.size() > 2) around.sort(edge);
    for (std::size_t i = 0; i < edge.size(); ++i)
      s.side.join(around.side(edge[i]), around.side(edge[(i + 1) % edge.size()], true));
  });
  return s;
}

/// Per side that names a shell: six times the volume that it bounds; negative: it bounds what is around.
std::vector<double> volumes(const Mesh& mesh, Shells& s) {
  const int n = (int)mesh.tris.size();
  std::vector<double> volume(2 * (std::size_t)n + 1, 0);
  for (int t = 0; t < n; ++t) {
    const double v = volume6(mesh, t, mesh.points[mesh.tris[s.component.find(t)][0]]);
    volume[s.side.find(2 * t)] -= v;
    volume[s.side.find(2 * t + 1)] += v;
  }
  return volume;
}

/// Joins the outer shell of every component with what is around it.
void nest(const Mesh& mesh, Shells& s, const std::vector<double>& volume) {
  const int n = (int)mesh.tris.size(), outside = 2 * n;
  std::vector<int> outer(n, -1), start(n, -1);  // by component: a side that names its outer shell, a triangle
  int components = 0;
  for (int t = 0; t < n; ++t)
    for (int side : {s.side.find(2 * t), s.side.find(2 * t + 1)}) {
      int& least = outer[s.component.find(t)];
      components += least < 0;
      if (least < 0 || volume[side] < volume[least]) least = side;
    }
  if (components == 1) {
    s.side.join(outer[s.component.find(0)], outside);
    return;
  }
  std::vector<double> most(n, -1);
  for (int t = 0; t < n; ++t) {
    const int c = s.component.find(t);
    const double across = area_vector(mesh, t).x;
    if (s.side.find(across > 0 ? 2 * t : 2 * t + 1) == outer[c] && std::abs(across) > most[c])
      most[c] = std::abs(across), start[c] = t;
  }
  const Bvh tree(mesh);
  for (int c = 0; c < n; ++c) {
    if (start[c] < 0) continue;
    int side = outer[c];
    for (const Crossing& x : crossings(mesh, tree, start[c], 1)) {
      const int near = 2 * x.triangle + (x.direction > 0);
      s.side.join(side, near);
      side = near ^ 1;
    }
    s.side.join(side, outside);
  }
}

}  // namespace

Solids find_solids(const Mesh& mesh) {
  const int n = (int)mesh.tris.size();
  Solids solids;
  if (n == 0) return solids;
  Shells s = connect(mesh);
  const std::vector<double> volume = volumes(mesh, s);
  nest(mesh, s, volume);
  std::vector<int> number(2 * (std::size_t)n + 1, -1);
  number[s.side.find(2 * n)] = 0;
  for (int t = 0; t < n; ++t) {
    std::array<int, 2>& sides = solids.sides.emplace_back();
    for (int i : {0, 1}) {
      int& region = number[s.side.find(2 * t + i)];
      if (region < 0) region = (int)solids.volume.size(), solids.volume.push_back(0);
      sides[i] = region;
    }
  }
  for (int side = 0; side < 2 * n; ++side)
    if (const int region = solids.sides[side / 2][side % 2]; region > 0)
      solids.volume[region] += volume[side] / 6;  // 0 except of the side that names a shell
  return solids;
}

bool divides_space(const Solids& solids) {
  constexpr double least = 1e-4;
  const double largest = *std::max_element(solids.volume.begin(), solids.volume.end());
  return std::any_of(solids.sides.begin(), solids.sides.end(), [&](const std::array<int, 2>& s) {
    return s[0] != s[1] && std::min(solids.volume[s[0]], solids.volume[s[1]]) > least * largest;
  });
}

std::vector<Vec3> points_within(const Mesh& mesh, const Solids& solids) {
  std::vector<Vec3> points(solids.volume.size());
  std::vector<int> start(points.size(), -1), ahead(points.size(), 1);
  std::vector<double> most(points.size(), -1);
  for (int t = 0; t < (int)mesh.tris.size(); ++t)
    for (int i : {0, 1}) {
      const int region = solids.sides[t][i];
      const double x = area_vector(mesh, t).x;
      if (std::abs(x) > most[region]) {
        most[region] = std::abs(x), start[region] = t;
        ahead[region] = (x > 0) == (i == 0) ? 1 : -1;
      }
    }
  if (mesh.tris.empty()) return points;
  const Bvh tree(mesh);
  for (int region = 1; region < (int)points.size(); ++region) {
    points[region] = centroid(mesh, start[region]);
    const std::vector<Crossing> found = crossings(mesh, tree, start[region], ahead[region]);
    if (!found.empty()) points[region].x = 0.5 * (points[region].x + found[0].x);
  }
  return points;
}

std::vector<SheetPatch> sheet_patches(Surface& surface, const Solids& solids, const std::vector<int>& label,
                                      std::vector<std::array<int, 2>>& added) {
  const int n = (int)surface.tris.size();
  if (!surface.face.has("patch")) surface.face.set("patch", std::vector<int>(n, 1));
  std::vector<int>& patch = surface.face.get<int>("patch");
  struct Row {
    SheetPatch sheet;
    int triangle;
    auto operator<=>(const Row&) const = default;
  };
  std::vector<Row> rows;
  for (int t = 0; t < n; ++t)
    rows.push_back({{patch[t], label[solids.sides[t][0]], label[solids.sides[t][1]]}, t});
  std::sort(rows.begin(), rows.end());
  int last = largest_patch(patch, rows.size()), was = 0;
  std::vector<SheetPatch> sheets;
  for (int i = 0; i < n; ++i) {
    const SheetPatch& s = rows[i].sheet;
    if (i == 0 || s != rows[i - 1].sheet) {
      const bool first = i == 0 || s.patch != was;
      was = s.patch;
      if (!first) added.push_back({++last, was});
      sheets.push_back({first ? was : last, s.front, s.back});
    }
    patch[rows[i].triangle] = sheets.back().patch;
  }
  std::sort(sheets.begin(), sheets.end());
  return sheets;
}

const SheetPatch* find_sheet(const std::vector<SheetPatch>& sheets, int patch) {
  const auto s = std::lower_bound(sheets.begin(), sheets.end(), patch,
                                  [](const SheetPatch& row, int p) { return row.patch < p; });
  return s != sheets.end() && s->patch == patch ? &*s : nullptr;
}

int row_of(const std::vector<RegionMeasure>& regions, int label) {
  const auto r = std::lower_bound(regions.begin(), regions.end(), label,
                                  [](const RegionMeasure& row, int l) { return row.label < l; });
  return r != regions.end() && r->label == label ? (int)(r - regions.begin()) : -1;
}

std::vector<RegionMeasure> measure_regions(const Surface& surface, const std::vector<SheetPatch>& sheets) {
  std::vector<int> labels;
  for (const SheetPatch& s : sheets) labels.insert(labels.end(), {s.front, s.back});
  sort_unique(labels);
  std::vector<RegionMeasure> regions;
  for (int label : labels) regions.push_back({label});
  const std::vector<int>& patch = surface.face.get<int>("patch");
  for (int t = 0; t < (int)patch.size(); ++t) {
    const SheetPatch* s = find_sheet(sheets, patch[t]);
    if (!s || s->front == s->back) continue;
    const double volume = volume6(surface, t, surface.points[0]) / 6,
                 area = 0.5 * norm(area_vector(surface, t));
    for (int side : {1, -1}) {
      RegionMeasure& r = regions[row_of(regions, side > 0 ? s->back : s->front)];
      r.volume += side * volume;
      r.area += area;
      ++r.triangles;
    }
  }
  return regions;
}

}  // namespace meshpipe
