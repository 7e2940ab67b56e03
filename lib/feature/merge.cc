// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/merge.h"

#include <algorithm>
#include <numbers>
#include <tuple>

#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/topology.h"
#include "lib/core/union_find.h"
#include "lib/feature/feature.h"

namespace meshpipe {
namespace {

/// A small patch that turns by more than this on all sides (60 degrees) is a step or an edge with a
/// thickness; triangles across its border would cut through the solid.
constexpr double steepest = 60 * std::numbers::pi / 180;
constexpr double tangent = 20 * std::numbers::pi / 180;  ///< patches that meet at less are tangent

/// The common border of two patches, by their indices.
struct Border {
  int a, b;
  double length = 0, turn = 0;  ///< turn: the angle between the normals, times length
  double sharp = 0;             ///< length where the angle is above the limit
};

int index_of(const PatchMerge& m, int label) {
  const auto i = std::lower_bound(m.patch.begin(), m.patch.end(), label);
  return i != m.patch.end() && *i == label ? (int)(i - m.patch.begin()) : -1;
}

/// Adds up rows for the same pair; those of a patch with itself are left out.
std::vector<Border> summed(std::vector<Border> rows) {
  for (Border& r : rows)
    if (r.a > r.b) std::swap(r.a, r.b);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Border& x, const Border& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
  std::vector<Border> out;
  for (const Border& r : rows) {
    if (r.a == r.b) continue;
    if (out.empty() || out.back().a != r.a || out.back().b != r.b)
      out.push_back(r);
    else
      out.back().length += r.length, out.back().turn += r.turn, out.back().sharp += r.sharp;
  }
  return out;
}

/// Borders between sets.
std::vector<Border> borders_of(const std::vector<Border>& rows, UnionFind& sets) {
  std::vector<Border> out = rows;
  for (Border& r : out) r.a = sets.find(r.a), r.b = sets.find(r.b);
  return summed(std::move(out));
}

}  // namespace

int PatchMerge::operator()(int label) const {
  const int i = index_of(*this, label);
  return i < 0 ? label : into[i];
}

int PatchMerge::count() const {
  int n = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) n += patch[i] == into[i];
  return n;
}

PatchMerge no_merge(const Surface& surface) {
  PatchMerge m;
  m.patch = surface.face.has("patch") ? surface.face.get<int>("patch") : std::vector<int>{1};
  sort_unique(m.patch);
  m.into = m.patch;
  return m;
}

void merge_groups(PatchMerge& merge, const std::vector<std::vector<int>>& groups) {
  for (const std::vector<int>& group : groups) {
    if (group.empty()) continue;
    for (int label : group)
      if (index_of(merge, label) < 0)
        throw NotAdmissible("no face has patch " + std::to_string(label) + ", which is to be merged");
    const int first = merge(group[0]);
    for (int label : group) {
      const int old = merge(label);
      std::replace(merge.into.begin(), merge.into.end(), old, first);
    }
  }
}

void merge_automatically(PatchMerge& merge, const Surface& surface, double h) {
  const int n = (int)merge.patch.size();
  if (n < 2) return;
  const std::vector<int> opposite = opposite_halfedges(surface);
  const Connectivity sides{surface, opposite};
  const std::vector<Vec3> normal = side_normals(sides, 0);
  const auto& label = surface.face.get<int>("patch");
  std::vector<int> patch(label.size());
  std::vector<double> area(n, 0), open(n, 0);  // open: length on the mesh border
  for (std::size_t t = 0; t < label.size(); ++t) {
    patch[t] = index_of(merge, merge(label[t]));
    area[patch[t]] += 0.5 * norm(sides.area_vector((int)t));
  }
  std::vector<Border> rows;
  for (int e = 0; e < (int)opposite.size(); ++e) {
    const int o = opposite[e], a = patch[e / 3];
    const double length = sides.length(e);
    if (o < 0) open[a] += length;
    if (o < e || patch[o / 3] == a) continue;
    const double turn = meshpipe::angle(normal[e / 3], normal[o / 3]);
    rows.push_back({a, patch[o / 3], length, turn * length, turn > tangent ? length : 0});
  }
  rows = summed(std::move(rows));

  UnionFind sets(n);
  for (const Border& r : rows)
    if (r.sharp <= 0.05 * r.length) sets.join(r.a, r.b);
  for (;;) {
    const std::vector<Border> now = borders_of(rows, sets);
    std::vector<double> size(n, 0), perimeter(n, 0);
    for (int i = 0; i < n; ++i) {
      size[sets.find(i)] += area[i];
      perimeter[sets.find(i)] += open[i];
    }
    for (const Border& r : now) {
      perimeter[r.a] += r.length;
      perimeter[r.b] += r.length;
    }
    std::vector<double> width(n);
    std::vector<int> small, best(n, -1);
    for (int i = 0; i < n; ++i) {
      width[i] = perimeter[i] > 0 ? 2 * size[i] / perimeter[i] : h;
      if (sets.find(i) == i && width[i] < 0.5 * h) small.push_back(i);
    }
    for (int k = 0; k < (int)now.size(); ++k)
      for (int i : {now[k].a, now[k].b})
        if (best[i] < 0 || now[k].turn * now[best[i]].length < now[best[i]].turn * now[k].length) best[i] = k;
    std::sort(small.begin(), small.end(),
              [&](int i, int j) { return std::tie(width[i], i) < std::tie(width[j], j); });
    bool joined = false;
    std::vector<char> changed(n, 0);  // the figures of these sets are recomputed before the next pass
    for (int i : small) {
      if (best[i] < 0 || now[best[i]].turn > steepest * now[best[i]].length) continue;
      if (changed[now[best[i]].a] || changed[now[best[i]].b]) continue;
      changed[now[best[i]].a] = changed[now[best[i]].b] = joined = true;
      sets.join(now[best[i]].a, now[best[i]].b);
    }
    if (!joined) break;
  }
  std::vector<int> largest(n, -1);
  for (int i = 0; i < n; ++i)
    if (int& l = largest[sets.find(i)]; l < 0 || area[i] > area[l]) l = i;
  for (int& into : merge.into) into = merge.patch[largest[sets.find(index_of(merge, into))]];
}

}  // namespace meshpipe
