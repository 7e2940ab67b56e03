// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "lib/core/bvh.h"
#include "lib/core/chord.h"
#include "lib/core/farthest.h"
#include "lib/core/fold.h"
#include "lib/core/intersect.h"
#include "lib/core/junctions.h"
#include "lib/core/sectors.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"
#include "lib/relax/repair.h"

namespace meshpipe {
namespace {

/// From where on a distance, in sizes, and a kappa are faults.
struct Limits {
  double distance, kappa;
};
constexpr Limits wanted{rules::too_far, rules::bearable_kappa},
    refused{rules::within_limit, rules::failing_kappa};

/// What is asked of the reference more than once, computed when it is needed.
struct Known {
  const Surface& reference;
  Samples& samples;
  Limits limits = wanted;
  IntersectingPairs intersections{};
  std::vector<double> walked{};    ///< per triangle, `deviation` over the size, at `time`
  std::vector<double> searched{};  ///< `distance_of` then, or -1
  int time = -1;
  std::optional<Mesh> contacts{};     ///< where the reference intersects itself
  std::optional<Bvh> contact_tree{};  ///< of these, if there are any
  std::optional<Bvh> built{};
  std::vector<char> corners{};

  /// Forgets the mesh: call it before it becomes another.
  void forget() {
    samples.forget();
    intersections = {}, time = -1;
    walked.clear(), searched.clear();
  }
  const Bvh& tree() { return built ? *built : built.emplace(reference); }
  /// Per vertex of the reference, whether feature edges meet there at so sharp an angle that no triangle
  /// between them has kappa 0.1.
  const std::vector<char>& needle_corners() {
    if (corners.empty()) {
      const std::vector<int> opposite = opposite_halfedges(reference);
      const Connectivity surface{reference, opposite, model_of(reference)};
      corners.resize(reference.points.size());
      for (const Sector& sector : needle_sectors(surface)) corners[surface.from(sector.first)] = 1;
    }
    return corners;
  }
};

/// What is wrong: pairs and folds, and a sum of distances and 1/kappa over what is bearable.
struct Fault : Intersections {
  int folds = 0;
  std::vector<int> triangles;  ///< those at folds, those that are too far from the reference, and needles
  std::vector<std::pair<int, Vec3>> missed;  ///< places of the reference, by the triangle nearest to them
  double excess = 0;

  bool none() const { return pairs.empty() && triangles.empty(); }
  int places() const { return (int)(pairs.size() + triangles.size()); }
  int count() const { return (int)pairs.size() + folds; }
  int involved() const {  // triangles
    std::vector<int> all = triangles;
    for (const auto& [a, b] : pairs) all.insert(all.end(), {a, b});
    sort_unique(all);
    return (int)all.size();
  }
  double sum() const { return rules::pair_excess * count() + excess; }
  bool less_than(const Fault& other) const {
    return Faults{{}, count(), sum()}.less_than({{}, other.count(), other.sum()});
  }
};

/// Drops the pairs that only touch in copies of the same vertices.
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

/// Pairs that intersect, and chords, where the reference has neither.
void find_intersections(const State& s, Known& known, Fault& found) {
  renew(known.intersections, s, known.samples.search);
  found.pairs = known.intersections.pairs;
  if (!s.copy.empty()) drop_contacts_of_sheets(s, found.pairs);
  for (const auto& pair : chords_of(s)) found.pairs.push_back(pair);
  sort_unique(found.pairs);
  if (found.pairs.empty()) return;
  if (!known.contacts) {
    Mesh joined = known.reference;
    if (!s.copy.empty()) join_borders(joined);
    known.contacts = contacts(joined, self_intersections(joined));
    if (!known.contacts->tris.empty()) known.contact_tree.emplace(*known.contacts);
  }
  found.of_reference = (int)found.pairs.size();
  if (known.contact_tree)
    found.pairs = new_intersections({s.points, s.mesh.tris}, found.pairs, *known.contact_tree);
  found.of_reference -= (int)found.pairs.size();
}

/// The edges, each by one half-edge, at which the mesh folds and the reference does not.
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

/// Returns the largest distance of triangle t from the reference that is found; it is not looked for where
/// all are at most `limit`. A walk may end on the wrong sheet, so it is searched for.
double distance_of(const State& s, int t, const Bvh& tree, double limit) {
  const auto [a, b, c] = s.mesh.tris[t];
  const std::array face{s.place[a].face, s.place[b].face, s.place[c].face};
  const Piece whole{{s.points[a], s.points[b], s.points[c]}, face, {0, 0, 0}};
  auto allowed = [&](int) { return limit; };
  return farthest(whole, s.reference->surface, allowed, [&](Vec3 p) { return tree.nearest(p); }).hit.distance;
}

/// How far triangle t and what is nearest to it may be apart, by this share of the size; `mean`: its mean.
double bearable_distance(const State& s, int t, double mean, double share = rules::too_far) {
  const Tri& v = s.mesh.tris[t];
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, norm(s.points[v[i]] - s.points[v[next(i)]]));
  const double size = (s.size[v[0]] + s.size[v[1]] + s.size[v[2]]) / 3;
  return share * std::max(mean, std::min(size, size_over_longest * longest));
}

/// Walks from the corners of triangles that have changed, except where no edge between their normals sags. A
/// border or model edge cuts bends of its line, however flat the surface is.
void look_at_changed(const State& s, Known& known) {
  const int n = (int)s.mesh.tris.size(), before = (int)known.walked.size();
  known.walked.resize(n), known.searched.resize(n);
#pragma omp parallel for schedule(dynamic, 256) if (n > 10000)
  for (int t = 0; t < n; ++t) {
    if (s.mesh.dead(t) || (t < before && !changed_since(s, t, known.time))) continue;
    const auto [a, b, c] = s.mesh.tris[t];
    const Vec3 normal = s.face_normal(t);
    const bool on_line = s.mesh.hard[3 * t] || s.mesh.hard[3 * t + 1] || s.mesh.hard[3 * t + 2];
    const bool flat = !on_line && std::min({dot(normal, s.normal[a]), dot(normal, s.normal[b]),
                                            dot(normal, s.normal[c])}) > rules::parallel;
    known.walked[t] = flat ? 0 : deviation(s, t) * std::max({s.target(a), s.target(b), s.target(c)});
    known.searched[t] = -1;
  }
  known.time = s.clocks.now;
}

/// Adds samples at places inside triangles of the reference that are farther from the mesh than they may be;
/// those on vertices and edges do not show these. Looks where one at a corner was measured after `time` and a
/// triangle of the mesh near a corner has another normal; with `all`, at all triangles longer than the size,
/// of which corners do not tell enough: there may be a whole fold between them.
void add_missed_places(const State& s, Samples& samples, int time, double share, bool all) {
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
    if (!all && std::max({x.time, y.time, z.time}) <= time) continue;
    const Piece whole{{reference.points[a], reference.points[b], reference.points[c]},
                      {x.near, y.near, z.near},
                      {x.distance, y.distance, z.distance}};
    if (whole.within(share * mean, mesh)) continue;
    if (all && whole.side(whole.longest()) <= mean) continue;
    const Vec3 normal = normalized(area_vector(reference, f));
    if (!all && std::all_of(whole.face.begin(), whole.face.end(),
                            [&](int t) { return dot(normal, s.face_normal(t)) > rules::parallel; }))
      continue;
    auto allowed = [&](int t) { return bearable_distance(s, t, mean, share); };
    const auto [p, hit, complete, halvings] =
        farthest(whole, mesh, allowed, [&](Vec3 q) { return samples.search.nearest(q, 1e300, 0); });
    if (hit.place.face < 0 || hit.distance <= allowed(hit.place.face)) continue;
#pragma omp critical
    missed.push_back({closest_place(reference, f, p), hit.place.face, s.clocks.now, hit.distance});
  }
  std::sort(missed.begin(), missed.end(),
            [](const Sample& a, const Sample& b) { return a.place.face < b.place.face; });
  samples.list.insert(samples.list.end(), missed.begin(), missed.end());
}

/// The triangle by whose size the distance of a sample at p is judged: of those that are as near to it, as
/// they are if a corner is the nearest place, the one with the smallest. mcheck may come upon any of them.
int judged_at(const State& s, Vec3 p, const Sample& x, double mean) {
  int judged = x.near;
  double least = bearable_distance(s, x.near, mean);
  for (int t : triangles_around(s, x.near, 1)) {
    const double bearable = bearable_distance(s, t, mean);
    if (bearable < least && norm(nearest_point(s, t, p) - p) <= (1 + rules::as_near) * x.distance)
      judged = t, least = bearable;
  }
  return judged;
}

/// The triangle with which the mesh may come nearer to sample x, at p: t, the nearest, or if that is of a
/// sheet that faces another way, the nearest of those that face as the reference does.
int triangle_to_refine(const State& s, const MeshTree& search, const Sample& x, Vec3 p, int t) {
  const Vec3 normal = s.reference->normal(x.place);
  if (dot(normal, s.face_normal(t)) >= 0) return t;
  double least = rules::own_sheet * x.distance;
  const Vec3 reach{least, least, least};
  search.overlapping({p - reach, p + reach}, [&](int u) {
    if (s.mesh.dead(u) || dot(normal, s.face_normal(u)) < 0) return;
    if (const double d = norm(nearest_point(s, u, p) - p); d < least) least = d, t = u;
  });
  return t;
}

/// Triangles that are too far from the reference, and those nearest to samples of it that are.
void find_far(const State& s, Known& known, Fault& found) {
  const double share = known.limits.distance;
  const double mean = mean_size(s), least = share * mean;
  std::vector<std::pair<int, double>> far;
  auto look_at_samples = [&](std::size_t first) {
    for (std::size_t i = first; i < known.samples.list.size(); ++i) {
      const Sample& x = known.samples.list[i];
      if (!(x.distance > least)) continue;
      const Vec3 p = s.reference->walk.point(x.place);
      const int judged = judged_at(s, p, x, mean);
      const double bearable = bearable_distance(s, judged, mean, share);
      if (x.distance <= bearable) continue;
      const int t = triangle_to_refine(s, known.samples.search, x, p, judged);
      far.push_back({t, -x.distance / bearable}), found.missed.push_back({t, p});
    }
  };
  sample_distances(s, known.samples, least);
  add_missed_places(s, known.samples, known.time, share, false);
  look_at_samples(0);
  look_at_changed(s, known);
  for (int t = 0; t < (int)s.mesh.tris.size(); ++t) {
    if (s.mesh.dead(t) || known.walked[t] <= rules::doubtful * least) continue;
    if (known.searched[t] < 0)
      known.searched[t] = distance_of(s, t, known.tree(), bearable_distance(s, t, mean, share));
    const double bearable = bearable_distance(s, t, mean, share);
    if (known.searched[t] > bearable) far.push_back({t, -known.searched[t] / bearable});
  }
  // takes long: only when little else is wrong
  if (const std::size_t n = known.samples.list.size();
      (int)far.size() + found.places() <= rules::few_to_look_on) {
    add_missed_places(s, known.samples, known.time, share, true);
    look_at_samples(n);
  }
  std::sort(far.begin(), far.end());
  for (int last = -1; auto [t, ratio] : far) {
    if (std::exchange(last, t) == t) continue;
    found.triangles.push_back(t), found.excess -= ratio;
  }
}

/// Is the needle t, of kappa k, no worse than the angle between two model edges at a corner forces it to be?
/// kappa of an isosceles triangle is 4 s (1 - s), s the sine of half the angle at its apex. Where the edges
/// bend, the angle between long ones may be less than that of the model, which is excuse only if it is sharp.
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
    if (isosceles <= rules::needed_kappa &&
        known.needle_corners()[known.reference.tris[place.face][nearest_corner(place)]])
      return true;
  }
  return false;
}

/// Triangles that are needles and that no corner forces; of too many only the worst.
void find_needles(const State& s, Known& known, Fault& found) {
  const EditMesh& m = s.mesh;
  std::vector<std::pair<double, int>> needles;
  for (int t = 0; t < (int)m.tris.size(); ++t) {
    if (m.dead(t)) continue;
    const auto [a, b, c] = m.tris[t];
    const double k = kappa(s.points[a], s.points[b], s.points[c]);
    if (k <= known.limits.kappa && !is_forced(s, t, k, known)) needles.push_back({k, t});
  }
  if ((int)needles.size() > rules::hopeless)
    std::erase_if(needles, [](const auto& n) { return n.first > rules::failing_kappa; });
  for (const auto& [k, t] : needles) {
    found.triangles.push_back(t);
    found.excess += std::min(rules::worst_needle, rules::bearable_kappa / k);
  }
}

/// Asks for smaller triangles around the offending ones, splits their longest edges and smooths.
void refine_at(State& s, const Fault& fault) {
  const EditMesh& m = s.mesh;
  std::vector<int> offending = fault.triangles, around, whole;  // corners of what cannot be split
  for (auto [a, b] : fault.pairs) offending.insert(offending.end(), {a, b});
  sort_unique(offending);
  for (int t : offending)
    for (int v : m.tris[t]) {
      around.push_back(v);
      m.neighbors(v, [&](int w) { around.push_back(w); });
    }
  sort_unique(around);
  for (int v : around) s.refinement[v] *= rules::refinement, mark_changed(s, v);
  for (int t : offending) {
    int longest = -1;
    double length = 0;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const double l = norm(s.points[m.to(h)] - s.points[m.from(h)]);
      if (l > length) length = l, longest = h;
    }
    if (longest >= 0 && split_edge(s, longest))
      around.push_back((int)m.out.size() - 1);
    else
      whole.insert(whole.end(), m.tris[t].begin(), m.tris[t].end());
  }
  for (int v : whole) {
    std::vector<int> edges;
    m.star(v, [&](int h) { edges.push_back(h); });
    for (int h : edges)  // a split leaves the other edges at v where they are
      if (!m.hard[h] && s.length(h) > rules::split_above && split_edge(s, h))
        around.push_back((int)m.out.size() - 1);
  }
  flip_to_shape(s);
  for (int repeat = 0; repeat < rules::sweeps_to_settle; ++repeat)
    for (int v : around) improve_vertex(s, v);
}

/// A patch as it was first, and what was found of it: an edit changes few of its triangles.
struct Before {
  Mesh mesh{};
  std::vector<double> deviation{};
  std::vector<std::pair<int, int>> pairs{};

  bool has(const Mesh& now, int t) const {
    if (t >= (int)mesh.tris.size() || now.tris[t] != mesh.tris[t]) return false;
    const Tri& v = now.tris[t];
    return std::all_of(v.begin(), v.end(), [&](int i) { return now.points[i] == mesh.points[i]; });
  }
};

/// How far a patch is from good: folds and pairs that intersect where the reference does not, distances over
/// what is bearable, there and from places of the reference, and 1/kappa of needles. The first patch that
/// is asked for becomes `before`.
double faultiness(const State& s, const std::vector<Vec3>& missed, double mean, Known& known,
                  Before& before) {
  double sum = 0;
  std::vector<std::pair<int, int>> pairs;
  std::vector<double> distance(missed.size(), 1e300), bearable(missed.size(), 1), far(s.mesh.tris.size(), 0);
  const Mesh mesh{s.points, s.mesh.tris};
  std::vector<Box> box(mesh.tris.size());
  std::vector<char> same(mesh.tris.size(), 0);
  for (int t = 0; t < (int)mesh.tris.size(); ++t) {
    if (s.mesh.dead(t)) continue;
    const auto [a, b, c] = mesh.tris[t];
    same[t] = before.has(mesh, t);
    const double most = bearable_distance(s, t, mean);
    far[t] = same[t] ? before.deviation[t] : deviation(s, t);
    const double there = far[t] * std::max({s.target(a), s.target(b), s.target(c)});
    sum += rules::far_weight * std::max(0.0, there / most - 1);
    if (const double k = kappa(s.points[a], s.points[b], s.points[c]);
        k <= rules::bearable_kappa && !is_forced(s, t, k, known))
      sum += rules::far_weight * (std::min(rules::worst_needle, rules::bearable_kappa / k) - 1);
    box[t] = box_of(mesh, t);
    for (int u = 0; u < t; ++u)
      if (!s.mesh.dead(u) && !(same[t] && same[u]) && overlap(box[t], box[u]) &&
          triangles_intersect(mesh, u, t))
        pairs.push_back({u, t});
    for (std::size_t i = 0; i < missed.size(); ++i)
      if (const double d = norm(closest_point(mesh, t, missed[i]) - missed[i]);
          d <= (1 + rules::as_near) * distance[i]) {
        const bool nearer = d < (1 - rules::as_near) * distance[i];
        bearable[i] = nearer ? most : std::min(most, bearable[i]);
        distance[i] = std::min(d, distance[i]);
      }
  }
  for (std::size_t i = 0; i < missed.size(); ++i)
    sum += rules::far_weight * std::max(0.0, distance[i] / bearable[i] - 1);
  if (!s.copy.empty()) drop_contacts_of_sheets(s, pairs);
  for (auto [t, u] : chords_of(s))
    if (!(same[t] && same[u])) pairs.push_back({t, u});
  sort_unique(pairs);
  if (known.contact_tree) pairs = new_intersections(mesh, pairs, *known.contact_tree);
  for (auto [t, u] : before.pairs)
    if (same[t] && same[u]) pairs.push_back({t, u});
  if (before.deviation.empty()) before = {mesh, far, pairs};
  return sum + rules::pair_weight * (double)(pairs.size() + folded_edges(s, known).size());
}

Fault find_faults(const State& s, Known& known) {
  Fault found;
  find_intersections(s, known, found);
  for (int h : folded_edges(s, known)) {
    ++found.folds;
    found.triangles.insert(found.triangles.end(), {h / 3, s.mesh.opp[h] / 3});
  }
  find_far(s, known, found);
  find_needles(s, known, found);
  sort_unique(found.triangles);
  return found;
}

/// Tries all edits where refinement did not help, and takes the best of each place.
void repair_at(State& s, const Fault& fault, Known& known) {
  struct Item {
    int t, other;
    std::vector<Vec3> missed;
  };
  std::vector<Item> items;
  for (auto [a, b] : fault.pairs) items.push_back({a, b, {}});
  for (int t : fault.triangles) items.push_back({t, -1, {}});
  for (Item& i : items)
    for (const auto& [t, p] : fault.missed)
      if (t == i.t || t == i.other) i.missed.push_back(p);
  const double mean = mean_size(s);
  known.tree(), known.needle_corners();  // before threads ask for them
  auto around = [&](const Item& item, std::vector<int> before) {
    if (!before.empty() || s.mesh.dead(item.t)) return before;
    std::vector<int> found = triangles_around(s, item.t, rules::thorough_rings);
    if (item.other >= 0 && !s.mesh.dead(item.other))
      for (int t : triangles_around(s, item.other, rules::rings))
        if (std::find(found.begin(), found.end(), t) == found.end()) found.push_back(t);
    if ((int)found.size() > rules::largest_patch) found.clear();
    return found;
  };
  auto attempt = [&](const Item& item, const std::vector<int>& triangles) {
    Before before;
    return repaired(s, triangles, true,
                    {[&](const State& patch) {
                       return objective(patch) + faultiness(patch, item.missed, mean, known, before);
                     },
                     true});
  };
  change_neighborhoods(s, items, INT_MAX, INT_MAX, around, attempt, [](const std::vector<int>&) {});
}

/// A mesh and its faults.
struct Seen {
  State mesh;
  Fault fault;
};

/// The meshes seen while faults are removed. Repair begins with the one with the lowest sum, since a few
/// pairs can often be repaired; `best` is the result.
struct Search {
  Known known;
  std::shared_ptr<const Seen> best{}, lowest{};
  Fault now{};
  int rounds = 0;
  bool better = false, lower = false;  ///< is the mesh looked at last?

  void look(const State& s) {
    now = find_faults(s, known);
    better = !best || now.less_than(best->fault);
    lower = !lowest || now.sum() < rules::less_excess * lowest->fault.sum();
    if (!better && !lower) return;
    const auto seen = std::make_shared<const Seen>(Seen{s, now});
    if (better) best = seen;
    if (lower) lowest = seen;
  }
  void go_to(State& s, const std::shared_ptr<const Seen>& seen) {
    s = seen->mesh, now = seen->fault;
    known.forget();
  }
  /// Does mcheck accept the best?
  bool is_accepted() {
    if (best->fault.count() > 0) return false;
    known.forget();
    const Limits limits = std::exchange(known.limits, refused);
    const bool none = find_faults(best->mesh, known).none();
    known.forget(), known.limits = limits;
    return none;
  }
  /// Goes on from the best by other limits: what was seen before counts no more.
  void go_on(State& s, Limits limits) {
    s = best->mesh;
    known.forget(), known.limits = limits;
    best = lowest = nullptr;
    look(s);
  }
};

/// Refines as long as it helps, or until mcheck accepts the best.
void refine(State& s, Search& search, double most) {
  Repairs memory;
  for (int useless = 0;
       useless < rules::useless_rounds && search.rounds < rules::fault_rounds && s.mesh.live <= most;) {
    const int n = (int)search.now.triangles.size(), since = s.clocks.now;
    refine_at(s, search.now);
    if (n > 0) reach_features(s, search.known.samples, rules::too_far, n), repair_worst(s, memory, since);
    search.look(s), ++search.rounds;
    if (search.now.none()) return;
    useless = search.better || search.lower ? 0 : useless + 1;
    if (useless == 1 && search.is_accepted()) return;
    if (search.now.sum() > rules::much_worse * search.lowest->fault.sum()) return;
  }
}

/// Repairs as long as it helps, from the mesh with the lowest sum, then from the best.
void repair(State& s, Search& search) {
  std::shared_ptr<const Seen> tried;
  for (const bool from_best : {false, true}) {
    const auto start = from_best ? search.best : search.lowest;
    if (start == tried || search.best->fault.none()) continue;
    if (start->fault.places() > rules::few_faults || start->fault.involved() > start->mesh.mesh.live / 2)
      continue;
    search.go_to(s, start), tried = start;
    for (int repairs = 0; repairs < rules::fault_repairs; ++repairs) {
      repair_at(s, search.now, search.known);
      search.look(s);
      if (search.now.none() || !(from_best ? search.better : search.lower)) break;
      tried = from_best ? search.best : search.lowest;
    }
  }
}

/// Where faults are more than mcheck accepts: none if there are too many. Of needles those are left out that
/// the model forces, also at smaller sizes.
std::vector<SizeReduction> reductions_at(const State& s, const Fault& fault, Known& known) {
  std::vector<SizeReduction> reductions;
  if (fault.places() > rules::few_faults) return reductions;
  const double mean = mean_size(s);
  auto add = [&](int t, double factor) {
    const auto [a, b, c] = s.mesh.tris[t];
    reductions.push_back({(1.0 / 3) * (s.points[a] + s.points[b] + s.points[c]), factor});
  };
  for (const auto& [t, u] : fault.pairs) add(t, rules::reduced_at_pair), add(u, rules::reduced_at_pair);
  for (int h : folded_edges(s, known))
    add(h / 3, rules::reduced_at_pair), add(s.mesh.opp[h] / 3, rules::reduced_at_pair);
  for (int t : fault.triangles) {
    const auto [a, b, c] = s.mesh.tris[t];
    const double k = kappa(s.points[a], s.points[b], s.points[c]);
    const double size = bearable_distance(s, t, mean, 1);
    double far = distance_of(s, t, known.tree(), rules::within_limit * size);
    for (const auto& [near, p] : fault.missed)
      if (near == t) far = std::max(far, norm(nearest_point(s, t, p) - p));
    far /= size;
    if (k <= rules::failing_kappa && k * rules::worst_needle >= rules::bearable_kappa &&
        !is_forced(s, t, k, known))
      add(t, rules::reduced_at_needle);
    else if (far > rules::within_limit)
      add(t, std::clamp(rules::reduced_at_distance / far, rules::least_reduced, rules::most_reduced));
  }
  return reductions;
}

}  // namespace

bool Faults::less_than(const Faults& other) const {
  if ((count == 0) != (other.count == 0)) return count == 0;
  return sum < rules::less_excess * other.sum;
}

Faults remove_faults(State& s, Samples& samples) {
  const double most = rules::growth * s.mesh.live + rules::few;
  Search search{{s.reference->surface, samples}};
  auto remove = [&] {
    if (!search.best->fault.none()) refine(s, search, most);
    if (!search.best->fault.none()) repair(s, search);
  };
  search.look(s);
  remove();
  if (!search.best->fault.none()) {
    // what is only less than wanted is not worth faults elsewhere
    search.go_on(s, refused);
    remove();
  }
  const Seen &best = *search.best, &lowest = *search.lowest;
  s = best.mesh;
  Faults left{best.fault, best.fault.count(), best.fault.sum(), lowest.fault.sum()};
  left.reductions = reductions_at(best.mesh, best.fault, search.known);
  if (!left.reductions.empty() && search.lowest != search.best)
    left.reductions = reductions_at(lowest.mesh, lowest.fault, search.known);
  return left;
}

}  // namespace meshpipe
