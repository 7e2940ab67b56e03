// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/mesh_tree.h"

#include "lib/core/intersect.h"

namespace meshpipe {

void MeshTree::Part::build(const State& s, std::vector<int> triangles) {
  tree.reset();
  number = std::move(triangles);
  mesh.tris.clear(), component.clear();
  if (number.empty()) return;
  mesh.points = s.points;
  for (int t : number) {
    mesh.tris.push_back(s.mesh.tris[t]);
    component.push_back(component_of(s, t));
  }
  tree.emplace(mesh);
}

void MeshTree::build(const State& s) {
  std::vector<int> all;
  triangles_ = (int)s.mesh.tris.size();
  for (int t = 0; t < triangles_; ++t)
    if (!s.mesh.dead(t)) all.push_back(t);
  built_.build(s, std::move(all));
}

/// Moves the first tree along, as far as its triangles are left.
void MeshTree::follow(const State& s) {
  built_.mesh.points = s.points;
  for (std::size_t i = 0; i < built_.number.size(); ++i) {
    if (s.mesh.dead(built_.number[i]))
      built_.component[i] = gone;
    else
      built_.mesh.tris[i] = s.mesh.tris[built_.number[i]];
  }
  built_.tree->refit();
}

void MeshTree::renew(const State& s) {
  if (time_ == s.clocks.now) return;
  time_ = s.clocks.now;
  std::vector<int> added;
  for (int t = triangles_; t >= 0 && t < (int)s.mesh.tris.size(); ++t)
    if (!s.mesh.dead(t)) added.push_back(t);
  if (triangles_ < 0 || (double)added.size() > rules::stale_share * s.mesh.live) {
    build(s);
    added.clear();
  } else {
    follow(s);
  }
  added_.build(s, std::move(added));
}

Bvh::Hit MeshTree::nearest(Vec3 p, int component, double bound, double enough) const {
  Bvh::Hit hit;
  for (const Part* part : {&built_, &added_}) {
    if (!part->tree || (hit.place.face >= 0 && hit.distance <= enough)) continue;
    Bvh::Hit other = part->tree->nearest_of(part->component, component, p, bound, enough);
    if (other.place.face < 0 || (hit.place.face >= 0 && !(other.distance < hit.distance))) continue;
    other.place.face = part->number[other.place.face];
    hit = other, bound = hit.distance;
  }
  return hit.place.face >= 0 || bound >= 1e300 ? hit : nearest(p, component, 1e300, enough);
}

std::vector<std::pair<int, int>> MeshTree::intersections() const {
  std::vector<std::pair<int, int>> pairs = self_intersections(built_.mesh, *built_.tree);
  std::erase_if(pairs, [&](const auto& p) {
    return built_.component[p.first] == gone || built_.component[p.second] == gone;
  });
  for (auto& [a, b] : pairs) a = built_.number[a], b = built_.number[b];
  return pairs;
}

void renew(IntersectingPairs& intersections, const State& s, MeshTree& search) {
  search.renew(s);
  auto& pairs = intersections.pairs;
  std::vector<int> changed;
  if (intersections.time < 0) {
    pairs = search.intersections();
    changed = search.added();
  } else {
    auto other = [&](int t) { return changed_since(s, t, intersections.time); };
    std::erase_if(pairs, [&](const auto& p) { return other(p.first) || other(p.second); });
    for (int t = 0; t < (int)s.mesh.tris.size(); ++t)
      if (!s.mesh.dead(t) && other(t)) changed.push_back(t);
  }
  intersections.time = s.clocks.now;
  const Mesh now{s.points, s.mesh.tris};
  for (int t : changed) {
    const Box box = box_of(now, t);
    search.overlapping(box, [&](int u) {
      if (u != t && overlap(box, box_of(now, u)) &&
          triangles_intersect(now, std::min(t, u), std::max(t, u)) && has_area(now, t) && has_area(now, u))
        pairs.push_back({std::min(t, u), std::max(t, u)});
    });
  }
  sort_unique(pairs);
}

}  // namespace meshpipe
