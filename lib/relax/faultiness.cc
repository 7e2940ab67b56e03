// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/faultiness.h"

#include "lib/core/intersect.h"

namespace meshpipe {
namespace {

/// Two triangles as a mesh: corners at the same place are one.
Mesh two_triangles(const std::vector<Vec3>& points, const Tri& t, const std::vector<Vec3>& others,
                   const Tri& u) {
  Mesh two{{}, {{0, 1, 2}, {3, 4, 5}}};
  for (int v : t) two.points.push_back(points[v]);
  for (int v : u) two.points.push_back(others[v]);
  for (int i = 0; i < 9; ++i)
    if (two.points[i / 3] == two.points[3 + i % 3]) two.tris[1][i % 3] = i / 3;
  return two;
}

/// How far two triangles intersect.
double length_of_contact(const Mesh& mesh, const std::pair<int, int>& pair) {
  const std::vector<Vec3> contact = contacts(mesh, {pair}).points;
  double length = 0;
  for (Vec3 p : contact) length = std::max(length, norm(p - contact[0]));
  return length;
}

/// What a pair adds to the faults of a patch.
double weight_of_pair(const Mesh& mesh, const std::pair<int, int>& pair, double mean) {
  const double length = std::min(1.0, length_of_contact(mesh, pair) / mean);
  return rules::pair_weight * (1 - rules::length_share * (1 - length));
}

/// The same of all pairs of triangle t and one around the patch.
double pairs_around(const Mesh& mesh, int t, const Box& box, const Surroundings& around, double mean,
                    const Known& known) {
  double sum = 0;
  for (int u = 0; u < (int)around.box.size(); ++u) {
    if (!overlap(box, around.box[u])) continue;
    const Mesh two = two_triangles(mesh.points, mesh.tris[t], around.mesh.points, around.mesh.tris[u]);
    if (!triangles_intersect(two, 0, 1)) continue;
    if (known.contact_tree && new_intersections(two, {{0, 1}}, *known.contact_tree).empty()) continue;
    sum += weight_of_pair(two, {0, 1}, mean);
  }
  return sum;
}

}  // namespace

Surroundings surroundings(const State& s, const MeshTree& tree, std::vector<int> triangles, double mean) {
  std::sort(triangles.begin(), triangles.end());
  auto box = [&](int t) {
    const auto [a, b, c] = s.mesh.tris[t];
    const Vec3 &p = s.points[a], &q = s.points[b], &r = s.points[c];
    return Box{lower(lower(p, q), r), upper(upper(p, q), r)};
  };
  Box reach = box(triangles[0]);
  for (int t : triangles) reach = join(reach, box(t));
  const double margin = rules::reach_of_patch * mean;
  reach.lo = reach.lo - Vec3{margin, margin, margin}, reach.hi = reach.hi + Vec3{margin, margin, margin};
  std::vector<int> around;
  tree.overlapping(reach, [&](int t) {
    if ((int)around.size() <= rules::most_around &&
        !std::binary_search(triangles.begin(), triangles.end(), t))
      around.push_back(t);
  });
  Surroundings found;
  if ((int)around.size() > rules::most_around) return found;
  std::sort(around.begin(), around.end());
  for (int t : around) {
    const int n = (int)found.mesh.points.size();
    for (int v : s.mesh.tris[t]) found.mesh.points.push_back(s.points[v]);
    found.mesh.tris.push_back({n, n + 1, n + 2}), found.box.push_back(box(t));
  }
  return found;
}

bool PatchBefore::has(const Mesh& now, int t) const {
  if (t >= (int)mesh.tris.size() || now.tris[t] != mesh.tris[t]) return false;
  const Tri& v = now.tris[t];
  return std::all_of(v.begin(), v.end(), [&](int i) { return now.points[i] == mesh.points[i]; });
}

double with_faultiness(const State& s, double sum, double bound, const std::vector<Vec3>& missed, double mean,
                       Known& known, PatchBefore& before) {
  const Mesh mesh{s.points, s.mesh.tris};
  const int n = (int)mesh.tris.size();
  std::vector<double> far(n, 0), bearable(n, 1), meets(n, 0);
  std::vector<char> same(n, 0);
  // what takes the least time first
  for (int t = 0; t < n && !(sum > bound); ++t) {
    if (s.mesh.dead(t)) continue;
    const auto [a, b, c] = mesh.tris[t];
    same[t] = before.has(mesh, t);
    if (same[t]) sum += meets[t] = before.meets[t];
    if (const double k = kappa(s.points[a], s.points[b], s.points[c]);
        k <= rules::bearable_kappa && !is_forced(s, t, k, known))
      sum += rules::far_weight * (std::min(rules::worst_needle, rules::bearable_kappa / k) - 1);
    bearable[t] = bearable_distance(s, t, mean);
    far[t] = same[t] ? before.deviation[t] : deviation(s, t);
    const double there = far[t] * std::max({s.target(a), s.target(b), s.target(c)});
    sum += rules::far_weight * std::max(0.0, there / bearable[t] - 1);
  }
  if (sum > bound) return sum;
  sum += rules::pair_weight * (double)folded_edges(s, known).size();
  std::vector<Box> box(n);
  std::vector<std::pair<int, int>> pairs;
  std::vector<double> distance(missed.size(), 1e300), bearable_there(missed.size(), 1);
  std::vector<int> seen, changed;  // triangles before t
  for (int t = 0; t < n && !(sum > bound); ++t) {
    if (s.mesh.dead(t)) continue;
    box[t] = box_of(mesh, t);
    if (!same[t]) sum += meets[t] = pairs_around(mesh, t, box[t], before.around, mean, known);
    for (int u : same[t] ? changed : seen)
      if (overlap(box[t], box[u]) && triangles_intersect(mesh, u, t)) pairs.push_back({u, t});
    seen.push_back(t);
    if (!same[t]) changed.push_back(t);
    for (std::size_t i = 0; i < missed.size(); ++i) {
      const Vec3 reach = (1 + 2 * rules::as_near) * distance[i] * Vec3{1, 1, 1};
      if (!overlap(box[t], {missed[i] - reach, missed[i] + reach})) continue;
      const double d = norm(closest_point(mesh, t, missed[i]) - missed[i]);
      if (d > (1 + rules::as_near) * distance[i]) continue;
      bearable_there[i] =
          d < (1 - rules::as_near) * distance[i] ? bearable[t] : std::min(bearable[t], bearable_there[i]);
      distance[i] = std::min(d, distance[i]);
    }
  }
  if (sum > bound) return sum;
  for (std::size_t i = 0; i < missed.size(); ++i)
    sum += rules::far_weight * std::max(0.0, distance[i] / bearable_there[i] - 1);
  if (!s.copy.empty()) drop_contacts_of_sheets(s, pairs);
  for (auto [t, u] : chords_of(s))
    if (!(same[t] && same[u])) pairs.push_back({t, u});
  sort_unique(pairs);
  if (known.contact_tree) pairs = new_intersections(mesh, pairs, *known.contact_tree);
  for (auto [t, u] : before.pairs)
    if (same[t] && same[u]) pairs.push_back({t, u});
  if (before.deviation.empty()) before = {before.around, mesh, far, meets, pairs};
  for (const auto& pair : pairs)
    if (!(sum > bound)) sum += weight_of_pair(mesh, pair, mean);
  return sum;
}

bool intersect(const State& s, int t, int u) {
  return triangles_intersect(two_triangles(s.points, s.mesh.tris[t], s.points, s.mesh.tris[u]), 0, 1);
}

}  // namespace meshpipe
