// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/faults.h"

#include "lib/core/chord.h"
#include "lib/core/farthest.h"
#include "lib/core/fold.h"
#include "lib/core/intersect.h"
#include "lib/core/original_triangles.h"

namespace meshpipe {

void drop_contacts_of_sheets(const State& s, std::vector<std::pair<int, int>>& pairs) {
  Mesh joined{s.points, s.mesh.tris};
  for (Tri& t : joined.tris)
    for (int& v : t)
      if (v >= 0) {
        int first = v;
        for_copies(s, v, [&](int c) { first = std::min(first, c); });
        v = first;
      }
  std::erase_if(pairs, [&](const auto& p) { return !triangles_intersect(joined, p.first, p.second); });
}

std::vector<std::pair<int, int>> chords_of(const State& s) {
  const EditMesh& m = s.mesh;
  return chord_pairs(
      m.tris, s.points, [&](int h) { return m.opp[h]; }, [&](int h) { return m.opp[h] < 0 || m.hard[h]; });
}

std::vector<int> folded_edges(const State& s, Known& known) {
  const EditMesh& m = s.mesh;
  std::vector<Vec3> normal(m.tris.size());
  for (int t = 0; t < (int)normal.size(); ++t)
    if (!m.dead(t)) normal[t] = s.face_normal(t);
  std::vector<int> folded;
  for (int h = 0; h < (int)m.opp.size(); ++h) {
    const int g = m.opp[h];
    if (g < h || m.dead(h / 3) || !turn_back(normal[h / 3], normal[g / 3])) continue;
    if (faces_one_way(s.points[m.from(h)], s.points[m.to(h)], normal[h / 3], normal[g / 3], known.reference,
                      known.tree()))
      folded.push_back(h);
  }
  return folded;
}

double distance_of(const State& s, int t, const Bvh& tree, double limit) {
  const auto [a, b, c] = s.mesh.tris[t];
  const std::array face{s.place[a].face, s.place[b].face, s.place[c].face};
  const Piece whole{{s.points[a], s.points[b], s.points[c]}, face, {0, 0, 0}};
  auto allowed = [&](int) { return limit; };
  return farthest(whole, s.reference->surface, allowed, [&](Vec3 p) { return tree.nearest(p); }).hit.distance;
}

double bearable_distance(const State& s, int t, double mean, double share) {
  const Tri& v = s.mesh.tris[t];
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, norm(s.points[v[i]] - s.points[v[next(i)]]));
  const double size = (s.size[v[0]] + s.size[v[1]] + s.size[v[2]]) / 3;
  return share * std::max(mean, std::min(size, size_over_longest * longest));
}

bool is_forced(const State& s, int t, double k, Known& known) {
  const EditMesh& m = s.mesh;
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    const Vec3 p = s.points[m.from(h)];
    if (!m.hard[h] || !m.hard[prev(h)] || s.hold[m.from(h)] != fixed) continue;
    const double half = std::sin(0.5 * angle(s.points[m.to(h)] - p, s.points[m.apex(h)] - p));
    const double isosceles = 4 * half * (1 - half);
    const double least = isosceles > rules::failing_kappa ? rules::failing_kappa : rules::needed_kappa;
    if (half >= rules::sharp_half || k < rules::leaning * isosceles) continue;
    if (k > least) return true;
    const Place& place = s.place[m.from(h)];
    const int corner = known.reference.tris[place.face][nearest_corner(place)];
    if (isosceles <= rules::needed_kappa && known.reference.points[corner] == p &&
        known.needle_corners()[corner])
      return true;
  }
  return false;
}

namespace {

/// Boxes around the pairs, with all contacts by which new_intersections tells whether they are new.
std::vector<Box> boxes_around(const Mesh& mesh, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<Box> boxes;
  for (const auto& [s, t] : pairs) {
    double reach = 0;
    for (int u : {s, t})
      for (int h = 3 * u; h < 3 * u + 3; ++h) reach = std::max(reach, 2 * edge_length(mesh, h));
    const Box both = join(box_of(mesh, s), box_of(mesh, t));
    boxes.push_back({both.lo - Vec3{reach, reach, reach}, both.hi + Vec3{reach, reach, reach}});
  }
  return boxes;
}

/// Pairs that intersect, and chords, where the reference has neither.
void find_intersections(const State& s, Known& known, Fault& found) {
  renew(known.of_mesh.intersections, s, known.samples.search);
  found.pairs = known.of_mesh.intersections.pairs;
  if (!s.copy.empty()) drop_contacts_of_sheets(s, found.pairs);
  for (const auto& pair : chords_of(s)) found.pairs.push_back(pair);
  sort_unique(found.pairs);
  if (found.pairs.empty()) return;
  const Mesh mesh{s.points, s.mesh.tris};
  const bool sheets_meet = !s.copy.empty(), first = !std::exchange(known.looked_near, true);
  if (first && (int)found.pairs.size() <= rules::few_pairs &&
      reference_contacts(known.reference, sheets_meet, boxes_around(mesh, found.pairs)).tris.empty())
    return;  // as on smooth surfaces: on these the others are hardly ever needed
  if (!known.contacts) {
    known.contacts = reference_contacts(known.reference, sheets_meet);
    if (!known.contacts->tris.empty()) known.contact_tree.emplace(*known.contacts);
  }
  found.of_reference = (int)found.pairs.size();
  if (known.contact_tree) found.pairs = new_intersections(mesh, found.pairs, *known.contact_tree);
  found.of_reference -= (int)found.pairs.size();
}

/// Walks from the corners of triangles that have changed, except where no edge between their normals sags. A
/// border or model edge cuts bends of its line, however flat the surface is.
void look_at_changed(const State& s, Known& known) {
  const int n = (int)s.mesh.tris.size(), before = (int)known.of_mesh.walked.size();
  known.of_mesh.walked.resize(n), known.of_mesh.searched.resize(n);
#pragma omp parallel for schedule(dynamic, 256) if (n > 10000)
  for (int t = 0; t < n; ++t) {
    if (s.mesh.dead(t) || (t < before && !changed_since(s, t, known.of_mesh.time))) continue;
    const auto [a, b, c] = s.mesh.tris[t];
    const Vec3 normal = s.face_normal(t);
    const bool on_line = s.mesh.hard[3 * t] || s.mesh.hard[3 * t + 1] || s.mesh.hard[3 * t + 2];
    const bool flat = !on_line && std::min({dot(normal, s.normal[a]), dot(normal, s.normal[b]),
                                            dot(normal, s.normal[c])}) > rules::parallel;
    known.of_mesh.walked[t] = flat ? 0 : deviation(s, t) * std::max({s.target(a), s.target(b), s.target(c)});
    known.of_mesh.searched[t] = -1;
  }
  known.of_mesh.time = s.clocks.now;
}

/// The triangle by whose size the distance to this place of the mesh is judged: of those that meet there, if
/// it is on an edge or a corner, the one with the smallest. mcheck may come upon any of them.
int judged_at(const State& s, const Place& place, double mean) {
  int judged = place.face;
  double least = bearable_distance(s, judged, mean);
  auto look = [&](int t) {
    if (const double d = bearable_distance(s, t, mean); d < least) judged = t, least = d;
  };
  const double b[] = {place.b0, place.b1, place.b2};
  for (int h = 3 * place.face; h < 3 * place.face + 3; ++h) {
    if (b[prev(h) % 3] == 0 && s.mesh.opp[h] >= 0) look(s.mesh.opp[h] / 3);
    if (b[h % 3] == 1)
      for_copies(s, s.mesh.from(h), [&](int v) { s.mesh.star(v, [&](int g) { look(g / 3); }); });
  }
  return judged;
}

/// Adds samples at places inside triangles of the reference that are farther from the mesh than they may be;
/// those on vertices and edges do not show these. Looks in triangle f, a `piece` with corners last measured
/// at `time`, if may_miss(f, piece, time).
template <class MayMiss>
void add_missed_places(const State& s, Samples& samples, double share, MayMiss may_miss) {
  const Surface& reference = s.reference->surface;
  const double mean = mean_size(s);
  const Mesh mesh{s.points, s.mesh.tris};
  std::vector<int> sample(reference.points.size(), -1);  // of each vertex; a tile does not have all
  for (int i = 0; i < (int)samples.list.size(); ++i)
    if (const Place& p = samples.list[i].place; std::max({p.b0, p.b1, p.b2}) == 1)
      sample[reference.tris[p.face][nearest_corner(p)]] = i;
  std::vector<Sample> missed;
#pragma omp parallel for schedule(dynamic, 256) if (reference.tris.size() > 10000)
  for (int f = 0; f < (int)reference.tris.size(); ++f) {
    const auto [a, b, c] = reference.tris[f];
    if (std::min({sample[a], sample[b], sample[c]}) < 0) continue;
    const Sample &x = samples.list[sample[a]], &y = samples.list[sample[b]], &z = samples.list[sample[c]];
    const Piece whole{{reference.points[a], reference.points[b], reference.points[c]},
                      {x.near, y.near, z.near},
                      {x.distance, y.distance, z.distance}};
    if (!may_miss(f, whole, std::max({x.time, y.time, z.time})) || whole.within(share * mean, mesh)) continue;
    auto allowed = [&](int t) { return bearable_distance(s, t, mean, share); };
    const int component = s.reference->component_of({f, 1, 0, 0});
    const auto [p, hit, complete, halvings] = farthest(whole, mesh, allowed, [&](Vec3 q) {
      Bvh::Hit nearest = samples.search.nearest(q, component, 1e300, 0);
      nearest.place.face = judged_at(s, nearest.place, mean);
      return nearest;
    });
    if (hit.place.face < 0 || hit.distance <= allowed(hit.place.face)) continue;
#pragma omp critical
    missed.push_back({closest_place(reference, f, p), hit.place.face, s.clocks.now, hit.distance});
  }
  std::sort(missed.begin(), missed.end(),
            [](const Sample& a, const Sample& b) { return a.place.face < b.place.face; });
  std::vector<char> again(reference.tris.size(), 0);  // one place inside a triangle is enough: the last
  for (const Sample& x : missed) again[x.place.face] = 1;
  std::erase_if(samples.list, [&](const Sample& x) {
    return again[x.place.face] && std::min({x.place.b0, x.place.b1, x.place.b2}) > 0;
  });
  samples.list.insert(samples.list.end(), missed.begin(), missed.end());
}

/// The triangles that have changed after `time`.
Mesh changed_triangles(const State& s, int time) {
  Mesh changed{s.points, {}};
  for (int t = 0; t < (int)s.mesh.tris.size(); ++t)
    if (!s.mesh.dead(t) && changed_since(s, t, time)) changed.tris.push_back(s.mesh.tris[t]);
  return changed;
}

/// The triangle with which the mesh may come nearer to sample x, at p: t, the nearest, or if that is of a
/// sheet that faces another way, the nearest of those that face as the reference does.
int triangle_to_refine(const State& s, const MeshTree& search, const Sample& x, Vec3 p, int t) {
  const Vec3 normal = s.reference->normal(x.place);
  if (dot(normal, s.face_normal(t)) >= 0) return t;
  const int component = s.reference->component_of(x.place);
  double least = rules::own_sheet * x.distance;
  const Vec3 reach{least, least, least};
  search.overlapping({p - reach, p + reach}, [&](int u) {
    if (s.mesh.dead(u) || dot(normal, s.face_normal(u)) < 0) return;
    if (component_of(s, u) != component) return;
    if (const double d = norm(nearest_point(s, u, p) - p); d < least) least = d, t = u;
  });
  return t;
}

/// Triangles that are too far from the reference, and those nearest to samples of it that are.
void find_far(const State& s, Known& known, Fault& found) {
  const double share = known.limits.distance;
  const double mean = mean_size(s), least = share * mean;
  std::vector<std::pair<int, double>> far;
  auto look_at_samples = [&] {
    found.missed.clear();
    for (const Sample& x : known.samples.list) {
      if (!(x.distance > least)) continue;
      const Vec3 p = s.reference->walk.point(x.place);
      const Tri& v = s.mesh.tris[x.near];
      const auto b = closest_on_triangle(p, s.points[v[0]], s.points[v[1]], s.points[v[2]]);
      const int judged = judged_at(s, {x.near, b[0], b[1], b[2]}, mean);
      const double bearable = bearable_distance(s, judged, mean, share);
      if (x.distance <= bearable) continue;
      const int t = triangle_to_refine(s, known.samples.search, x, p, judged);
      far.push_back({t, -x.distance / bearable}),
          found.missed.push_back({t, p, share * x.distance / bearable});
    }
  };
  int since = known.of_mesh.time;
  if (mean < rules::same_mean * known.of_mesh.mean) {  // what was near enough may not be now
    since = known.of_mesh.looked = -1, known.of_mesh.mean = 0;
    std::fill(known.of_mesh.searched.begin(), known.of_mesh.searched.end(), -1);
  }
  known.of_mesh.mean = std::max(known.of_mesh.mean, mean);
  sample_distances(s, known.samples, least);
  add_missed_places(s, known.samples, share, [&](int f, const Piece& whole, int time) {
    if (time <= since) return false;
    const Vec3 normal = normalized(area_vector(known.reference, f));
    return std::any_of(whole.face.begin(), whole.face.end(),
                       [&](int t) { return dot(normal, s.face_normal(t)) <= rules::parallel; });
  });
  look_at_samples();
  look_at_changed(s, known);
  for (int t = 0; t < (int)s.mesh.tris.size(); ++t) {
    if (s.mesh.dead(t) || known.of_mesh.walked[t] <= rules::doubtful * least) continue;
    if (known.of_mesh.searched[t] < 0)
      known.of_mesh.searched[t] = distance_of(s, t, known.tree(), bearable_distance(s, t, mean, share));
    const double bearable = bearable_distance(s, t, mean, share);
    if (known.of_mesh.searched[t] > bearable) far.push_back({t, -known.of_mesh.searched[t] / bearable});
  }
  // of triangles much longer than the size corners do not show enough: there may be a whole fold between them
  const Mesh changed = known.of_mesh.looked < 0 ? Mesh{} : changed_triangles(s, known.of_mesh.looked);
  const double most = std::max(mean, *std::max_element(s.size.begin(), s.size.end()));
  std::optional<Bvh> tree;
  if (!changed.tris.empty()) tree.emplace(changed);
  add_missed_places(s, known.samples, share, [&](int f, const Piece& whole, int) {
    if (!(whole.side(whole.longest()) > rules::long_side * mean)) return false;
    bool near = known.of_mesh.looked < 0;
    const Vec3 reach{most, most, most};
    const Box box = box_of(known.reference, f);
    if (tree) tree->overlapping({box.lo - reach, box.hi + reach}, [&](int) { near = true; });
    return near;
  });
  known.of_mesh.looked = s.clocks.now;
  look_at_samples();
  std::sort(far.begin(), far.end());
  for (int last = -1; auto [t, ratio] : far) {
    if (std::exchange(last, t) == t) continue;
    found.triangles.push_back(t), found.excess -= ratio;
    if (-ratio * share > refused.distance) found.acceptable = false;
  }
}

/// Triangles that are needles and that no corner forces.
void find_needles(const State& s, Known& known, Fault& found) {
  const EditMesh& m = s.mesh;
  for (int t = 0; t < (int)m.tris.size(); ++t) {
    if (m.dead(t)) continue;
    const auto [a, b, c] = m.tris[t];
    const double k = kappa(s.points[a], s.points[b], s.points[c]);
    if (k > rules::bearable_kappa || is_forced(s, t, k, known)) continue;
    if (k > known.limits.kappa) {
      ++found.mild;
      continue;
    }
    found.triangles.push_back(t);
    found.excess += std::min(rules::worst_needle, rules::bearable_kappa / k);
    if (k <= refused.kappa) found.acceptable = false;
  }
}

}  // namespace

Fault find_faults(const State& s, Known& known) {
  Fault found;
  find_intersections(s, known, found);
  for (int h : folded_edges(s, known)) {
    ++found.folds;
    found.triangles.insert(found.triangles.end(), {h / 3, s.mesh.opp[h] / 3});
  }
  find_far(s, known, found);
  find_needles(s, known, found);
  if (found.count() > 0) found.acceptable = false;
  sort_unique(found.triangles);
  return found;
}

}  // namespace meshpipe
