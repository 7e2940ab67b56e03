// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <memory>
#include <mutex>
#include <unordered_set>

#include "lib/relax/faultiness.h"

namespace meshpipe {
namespace {

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

/// The neighborhoods that repair has tried in vain, by their fingerprints, at this mean size.
struct InVain {
  double mean = 0;
  std::unordered_set<std::uint64_t> tried{};
};

/// A number from what an attempt to repair depends on: triangles, those around them, places of the reference
/// near to them, and the bits of `how`; not from the mean size, see InVain.
std::uint64_t fingerprint(const State& s, const std::vector<int>& triangles, const Surroundings& around,
                          const std::vector<Vec3>& missed, unsigned how) {
  std::uint64_t sum = how;
  auto add = [&](auto x) {
    sum = (std::rotl(sum, 23) ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
  };
  auto add_point = [&](Vec3 p) { add(p.x), add(p.y), add(p.z); };
  for (int t : triangles)
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const int v = s.mesh.from(h);
      add_point(s.points[v]), add(s.refinement[v]);
      add((std::uint64_t)s.hold[v] << 2 | (std::uint64_t)(s.mesh.opp[h] < 0) << 1 | (s.mesh.hard[h] != 0));
    }
  for (Vec3 p : around.mesh.points) add_point(p);
  for (Vec3 p : missed) add_point(p);
  return sum;
}

/// Tries all edits where refinement did not help, and takes the best of each place. Of many pairs first
/// single edits. Pairs that the repair of others has removed are left out, except chords, which need not
/// intersect, and so are neighborhoods tried `in_vain` before.
void repair_at(State& s, const Fault& fault, Known& known, InVain& in_vain) {
  struct Item {
    int t, other;
    bool intersects;
    std::vector<Vec3> missed;
  };
  std::vector<Item> items;
  for (auto [a, b] : fault.pairs) items.push_back({a, b, intersect(s, a, b), {}});
  for (int t : fault.triangles) items.push_back({t, -1, false, {}});
  for (Item& i : items)
    for (const MissedPlace& m : fault.missed)
      if (m.near == i.t || m.near == i.other) i.missed.push_back(m.at);
  const double mean = mean_size(s);
  if (!(std::min(mean, in_vain.mean) > rules::same_mean * std::max(mean, in_vain.mean))) in_vain = {mean, {}};
  const int begun = s.clocks.now;
  bool thorough = (int)fault.pairs.size() <= rules::many_pairs;
  known.tree(), known.needle_corners();  // before threads ask for them
  MeshTree& search = known.samples.search;
  auto print_of = [&](const Item& item, const std::vector<int>& triangles, const Surroundings& around) {
    const unsigned contacts = known.contact_tree.has_value();
    return fingerprint(s, triangles, around, item.missed,
                       (unsigned)thorough | (unsigned)s.acute << 1 | contacts << 2);
  };
  auto around = [&](const Item& item, std::vector<int> before) {
    if (!before.empty() || s.mesh.dead(item.t)) return before;
    if (item.intersects && (changed_since(s, item.t, begun) || changed_since(s, item.other, begun)) &&
        (s.mesh.dead(item.other) || !intersect(s, item.t, item.other)))
      return std::vector<int>{};
    std::vector<int> found = triangles_around(s, item.t, thorough ? rules::thorough_rings : rules::rings);
    if (item.other >= 0 && !s.mesh.dead(item.other)) {
      for (int t : triangles_around(s, item.other, rules::rings))
        if (std::find(found.begin(), found.end(), t) == found.end()) found.push_back(t);
      const auto second = std::find(found.begin(), found.end(), item.other);
      std::rotate(found.begin() + 1, second, second + 1);
    }
    search.renew(s);
    if ((int)found.size() > rules::largest_patch ||
        in_vain.tried.count(print_of(item, found, surroundings(s, search, found, mean))))
      found.clear();
    return found;
  };
  std::mutex one_at_a_time;
  auto attempt = [&](const Item& item, const std::vector<int>& triangles) {
    PatchBefore before{surroundings(s, search, triangles, mean)};
    auto better =
        repaired(s, triangles, thorough,
                 {[&](const State& patch, double bound) {
                    return with_faultiness(patch, objective(patch), bound, item.missed, mean, known, before);
                  },
                  true, triangles.size() > 1 && triangles[1] == item.other ? 2 : 1});
    if (!better) {
      const std::lock_guard lock(one_at_a_time);
      in_vain.tried.insert(print_of(item, triangles, before.around));
    }
    return better;
  };
  auto repair = [&](const std::vector<Item>& at) {
    change_neighborhoods(s, at, INT_MAX, INT_MAX, around, attempt, [](const std::vector<int>&) {});
  };
  if (!thorough) repair({items.begin(), items.begin() + (int)fault.pairs.size()});
  thorough = true;
  repair(items);
}

/// A mesh, its faults, and what they were found by.
struct Seen {
  State mesh;
  Fault fault;
  MeasuredMesh measured;
  std::vector<Sample> samples;
};

/// The meshes seen while faults are removed. Repair begins with the one with the lowest sum, since a few
/// pairs can often be repaired. The result is `accepted`, the best of those that mcheck accepts, or else
/// `best`.
struct Search {
  Known known;
  InVain in_vain{};
  int shapes_in_vain = 0;  ///< places around refined ones where pairs of edits for the shape have failed
  std::shared_ptr<const Seen> best{}, lowest{}, accepted{}, last{};
  Fault now{};
  int rounds = 0;
  bool better = false, lower = false;  ///< is the mesh looked at last?

  void look(const State& s) {
    now = find_faults(s, known);
    better = !best || now.less_than(best->fault);
    lower = !lowest || now.sum() < rules::less_excess * lowest->fault.sum();
    const bool best_accepted = now.acceptable && (!accepted || now.less_than(accepted->fault));
    last = nullptr;
    if (!better && !lower && !best_accepted) return;
    last = std::make_shared<const Seen>(Seen{s, now, known.of_mesh, known.samples.list});
    if (better) best = last;
    if (lower) lowest = last;
    if (best_accepted) accepted = last;
  }
  void go_to(State& s, std::shared_ptr<const Seen> seen) {
    now = seen->fault;
    if (seen == last && s.clocks.now == seen->mesh.clocks.now) return;  // s is as it was seen
    s = seen->mesh, known.of_mesh = seen->measured;
    known.samples.go_back(seen->samples);
    last = std::move(seen);
  }
  /// Goes on from the result by other limits: what was seen before counts no more.
  void go_on(State& s, Limits limits) {
    go_to(s, accepted ? accepted : best);
    // another look at all: of changed places only samples that are near to what has changed were looked at
    if (limits.distance != known.limits.distance) known.samples.forget(), known.of_mesh = {};
    known.limits = limits;
    best = lowest = accepted = nullptr;
    look(s);
  }
};

/// Refines as long as it helps. Pairs are repaired first: split they intersect in more places.
void refine(State& s, Search& search, double most) {
  Repairs memory;  // of this mesh: times of another say nothing
  memory.in_vain = search.shapes_in_vain;
  int since = s.clocks.now;  // when all was repaired
  bool repair_helps = true;
  for (int useless = 0;
       useless < rules::useless_rounds && search.rounds < rules::fault_rounds && s.mesh.live <= most;) {
    bool helps = false;
    if (repair_helps && !search.now.pairs.empty() && (int)search.now.pairs.size() <= rules::few_faults) {
      Fault pairs;
      pairs.pairs = search.now.pairs, pairs.missed = search.now.missed;
      repair_at(s, pairs, search.known, search.in_vain);
      search.look(s);
      if (search.now.none()) return;
      helps = repair_helps = search.better || search.lower;
    }
    const int n = (int)search.now.triangles.size();
    refine_at(s, search.now);
    if (n > 0) {
      reach_features(s, search.known.samples, rules::too_far, n);
      repair_worst(s, memory, since);
      search.shapes_in_vain = memory.in_vain;
      since = s.clocks.now;
    }
    search.look(s), ++search.rounds;
    if (search.now.none()) return;
    helps = helps || search.better || search.lower;
    useless = helps ? 0 : useless + 1;
    if (useless == 1 && search.accepted) return;
    if (search.now.sum() > rules::much_worse * search.lowest->fault.sum()) return;
  }
}

/// Repairs as long as it helps, from the mesh with the lowest sum, then from the best.
void repair(State& s, Search& search) {
  std::shared_ptr<const Seen> tried;
  for (const bool from_best : {false, true}) {
    const auto start = from_best ? search.best : search.lowest;
    if (start == tried || search.best->fault.none()) continue;
    if (start->fault.sum() > rules::most_repaired) continue;
    search.go_to(s, start), tried = start;
    for (int repairs = 0; repairs < rules::fault_repairs; ++repairs) {
      repair_at(s, search.now, search.known, search.in_vain);
      search.look(s);
      if (search.now.none() || !(from_best ? search.better : search.lower)) break;
      tried = from_best ? search.best : search.lowest;
    }
  }
}

/// Repairs the mild needles of the accepted mesh. If another look no longer accepts it, none is accepted.
void repair_mild(State& s, Search& search) {
  search.go_on(s, {search.known.limits.distance, rules::bearable_kappa});
  if (!search.accepted) return;
  repair_at(s, search.now, search.known, search.in_vain);
  search.look(s);
}

/// Where faults are more than mcheck accepts: none if too much is wrong. Of needles those are left out that
/// the model forces, also at smaller sizes.
std::vector<SizeReduction> reductions_at(const State& s, const Fault& fault, Known& known) {
  std::vector<SizeReduction> reductions;
  if (fault.sum() > rules::most_left) return reductions;
  const double mean = mean_size(s);
  auto add = [&](int t, double factor) {
    const auto [a, b, c] = s.mesh.tris[t];
    reductions.push_back({(1.0 / 3) * (s.points[a] + s.points[b] + s.points[c]), factor});
  };
  auto at_distance = [](double far) {
    return std::clamp(rules::reduced_at_distance / far, rules::least_reduced, rules::most_reduced);
  };
  for (const MissedPlace& m : fault.missed)
    if (m.distance > rules::within_limit) reductions.push_back({m.at, at_distance(m.distance)});
  for (const auto& [t, u] : fault.pairs) add(t, rules::reduced_at_pair), add(u, rules::reduced_at_pair);
  for (int h : folded_edges(s, known))
    add(h / 3, rules::reduced_at_pair), add(s.mesh.opp[h] / 3, rules::reduced_at_pair);
  for (int t : fault.triangles) {
    const auto [a, b, c] = s.mesh.tris[t];
    const double k = kappa(s.points[a], s.points[b], s.points[c]);
    const double size = bearable_distance(s, t, mean, 1);
    const double far = distance_of(s, t, known.tree(), rules::within_limit * size) / size;
    if (k <= rules::failing_kappa && k * rules::worst_needle >= rules::bearable_kappa &&
        !is_forced(s, t, k, known))
      add(t, rules::reduced_at_needle);
    else if (far > rules::within_limit)
      add(t, at_distance(far));
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
  search.look(s);
  const bool too_many = search.now.sum() > std::max(rules::most_sum, rules::most_sum_share * s.mesh.live);
  // in turns, each from the mesh with the lowest sum: refinement only adds faults where many are left
  auto remove = [&] {
    double worth = infinity;
    while (!too_many && !search.best->fault.none() && search.lowest->fault.sum() <= worth) {
      worth = std::min(rules::nearly_accepted, rules::worth_a_turn * search.lowest->fault.sum());
      search.go_to(s, search.lowest);
      refine(s, search, most);
      if (!search.best->fault.none()) repair(s, search);
      if (search.accepted) break;
    }
  };
  remove();
  if (search.accepted) {
    const int mild = search.accepted->fault.mild;
    if (mild > 0 && mild <= rules::few_faults) repair_mild(s, search);
  }
  // limits without a margin allow distances, but no pairs; at the same triangles nothing else would come out
  const std::vector<int> faulty = search.best->fault.triangles;
  if (!search.accepted && !too_many && search.best->fault.count() == 0 &&
      search.best->fault.sum() < rules::nearly_accepted)
    if (search.go_on(s, refused); !search.accepted && search.best->fault.triangles != faulty) remove();
  if (search.accepted) {
    search.go_to(s, search.accepted);
    return {{{}, search.now.of_reference}};
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
