// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lib/clean/repair.h"
#include "lib/core/edges.h"
#include "lib/core/largest_patch.h"
#include "lib/core/topology.h"

namespace meshpipe {

bool mark_sheets(Surface& surface, const Repair& apart, CleanReport& report) {
  const int n = (int)surface.tris.size();
  std::vector<int> component;
  const int n_sheets = components(apart.opposite, component);
  std::vector<std::uint8_t> model(n, 0);
  if (surface.face.has("model")) model = surface.face.get<std::uint8_t>("model");
  std::vector<char> meets(n_sheets, 0);
  bool changed = false;
  for_each_edge(surface.tris, (int)surface.points.size(), [&](std::span<const EdgeUse> uses) {
    if (uses.size() < 2) return;
    for (EdgeUse e : uses) {
      const int h = half_edge(e);
      if (uses.size() == 2 && apart.opposite[h] >= 0) continue;
      meets[component[h / 3]] = 1;
      changed = changed || !(model[h / 3] >> h % 3 & 1);
      model[h / 3] |= 1 << h % 3;
    }
  });
  if (changed) surface.face.set("model", std::move(model));

  std::vector<int> patch(n, 1);
  if (surface.face.has("patch")) patch = surface.face.get<int>("patch");
  struct Label {
    int patch, sheet, triangle;
    auto operator<=>(const Label&) const = default;
  };
  std::vector<Label> labels;
  for (int t = 0; t < n; ++t)
    if (meets[component[t]]) labels.push_back({patch[t], component[t], t});
  std::sort(labels.begin(), labels.end());
  int last = largest_patch(patch, labels.size());
  for (std::size_t i = 1; i < labels.size(); ++i) {
    const Label &before = labels[i - 1], &l = labels[i];
    if (l.patch != before.patch) continue;
    if (l.sheet != before.sheet) report.sheets.patches.push_back({++last, l.patch});
    const bool first = report.sheets.patches.empty() || report.sheets.patches.back()[1] != l.patch;
    if (!first) patch[l.triangle] = last;
  }
  if (report.sheets.patches.empty()) return changed;
  surface.face.set("patch", std::move(patch));
  return true;
}

std::vector<std::array<int, 2>> solids_of_patches(const Repair& r, const Surface& input,
                                                  const std::vector<std::array<int, 2>>& doubles) {
  std::vector<std::array<int, 2>> sides;
  if (doubles.empty() || !input.face.has("patch")) return sides;
  const std::vector<int>& patch = input.face.get<int>("patch");
  std::vector<int> other(patch.size(), 0);
  for (const auto& [kept, gone] : doubles) {
    if (patch[kept] == patch[gone]) return sides;
    other[kept] = patch[gone];
  }
  for (int t : r.face) sides.push_back({patch[t], other[t]});
  const bool positive =
      std::all_of(r.face.begin(), r.face.end(), [&](int t) { return patch[t] > 0 && other[t] >= 0; });
  if (!positive) sides.clear();
  return sides;
}

}  // namespace meshpipe
