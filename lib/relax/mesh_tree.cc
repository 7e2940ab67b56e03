// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/mesh_tree.h"

#include "lib/core/intersect.h"

namespace meshpipe {
namespace {

/// The triangles that have changed after `time` and are not gone.
std::vector<int> changed_triangles(const State& s, int time) {
  std::vector<int> changed;
  for (int t = 0; t < (int)s.mesh.tris.size(); ++t)
    if (!s.mesh.dead(t) && changed_since(s, t, time)) changed.push_back(t);
  return changed;
}

}  // namespace

void MeshTree::renew(const State& s) {
  if (time_ == s.clocks.now) return;
  tree_.reset();
  mesh_ = without_gaps(s, number_);
  tree_.emplace(mesh_);
  time_ = s.clocks.now;
}

void renew(Crossings& crossings, const State& s, MeshTree& search) {
  const int before = crossings.time;
  crossings.time = s.clocks.now;
  auto& pairs = crossings.pairs;
  if (before < 0 || search.time() < 0) {
    search.renew(s);
    pairs = self_intersections(search.mesh(), search.tree());
    for (auto& [a, b] : pairs) a = search.number(a), b = search.number(b);
    return;
  }
  std::erase_if(pairs, [&](const auto& p) {
    return changed_since(s, p.first, before) || changed_since(s, p.second, before);
  });
  // the tree finds what is as it was then, another one the rest
  std::vector<int> other = changed_triangles(s, search.time());
  if ((int)other.size() > rules::stale_share * s.mesh.live) search.renew(s), other.clear();
  const Mesh now{s.points, s.mesh.tris};
  Mesh part{other.empty() ? std::vector<Vec3>{} : s.points, {}};
  for (int t : other) part.tris.push_back(s.mesh.tris[t]);
  std::optional<Bvh> rest;
  if (!other.empty()) rest.emplace(part);
  for (int t : changed_triangles(s, before)) {
    const Box box = box_of(now, t);
    auto look = [&](int u) {
      if (u != t && overlap(box, box_of(now, u)) && has_area(now, t) && has_area(now, u) &&
          triangles_intersect(now, std::min(t, u), std::max(t, u)))
        pairs.push_back({std::min(t, u), std::max(t, u)});
    };
    search.tree().overlapping(box, [&](int i) {
      if (const int u = search.number(i); !changed_since(s, u, search.time())) look(u);
    });
    if (rest) rest->overlapping(box, [&](int i) { look(other[i]); });
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace meshpipe
