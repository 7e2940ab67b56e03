// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/intersect.h"
#include "lib/relax/repair.h"

namespace meshpipe {
namespace {

/// Where the reference intersects itself, computed once it is needed.
using Known = std::optional<Mesh>;

Intersections find_intersections(const State& s, Known& known) {
  std::vector<int> number;
  const Mesh now = without_gaps(s, number);
  Intersections found{self_intersections(now), 0};
  if (found.pairs.empty()) return found;
  const Surface& reference = s.reference->surface;
  if (!known) known = contacts(reference, self_intersections(reference));
  const int all = (int)found.pairs.size();
  found.pairs = new_intersections(now, found.pairs, *known);
  found.of_reference = all - (int)found.pairs.size();
  for (auto& [a, b] : found.pairs) a = number[a], b = number[b];
  return found;
}

/// Asks for smaller triangles around the offending ones, splits their longest edges and smooths.
void refine_at(State& s, const std::vector<std::pair<int, int>>& pairs) {
  const EditMesh& m = s.mesh;
  std::vector<int> offending, around;
  for (auto [a, b] : pairs) offending.insert(offending.end(), {a, b});
  sort_unique(offending);
  for (int t : offending)
    for (int v : m.tris[t]) {
      around.push_back(v);
      m.neighbors(v, [&](int w) { around.push_back(w); });
    }
  sort_unique(around);
  for (int v : around) {
    s.refinement[v] *= rules::refinement;
    mark_changed(s, v);
  }
  for (int t : offending) {
    int longest = -1;
    double length = 0;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const double l = norm(s.points[m.to(h)] - s.points[m.from(h)]);
      if (l > length) length = l, longest = h;
    }
    if (longest >= 0 && split_edge(s, longest)) around.push_back((int)m.out.size() - 1);
  }
  flip_to_shape(s);
  for (int repeat = 0; repeat < rules::sweeps_to_settle; ++repeat)
    for (int v : around) improve_vertex(s, v);
}

}  // namespace

Intersections separate(State& s) {
  const int most = s.mesh.live + s.mesh.live / 4 + 1000;
  std::optional<std::pair<State, Intersections>> best;
  Known known;
  for (int round = 0, since_best = 0;; ++round) {
    Intersections found = find_intersections(s, known);
    if (found.pairs.empty()) return found;
    const bool better = !best || found.pairs.size() < best->second.pairs.size();
    since_best = better ? 0 : since_best + 1;
    if (since_best == rules::useless_rounds || round == rules::separate_rounds || s.mesh.live > most) {
      if (better) return found;
      s = std::move(best->first);
      return std::move(best->second);
    }
    const auto pairs = found.pairs;
    if (better) best = {s, std::move(found)};
    refine_at(s, pairs);
  }
}

}  // namespace meshpipe
