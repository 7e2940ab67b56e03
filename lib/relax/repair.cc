// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/repair.h"

#include "lib/relax/junctions.h"

namespace meshpipe {
namespace {

/// Slides an end v of h along its line to `at` times the length of h from the other, and holds it there.
bool slide_end(State& s, int h, int v, double at) {
  const Vec3 from = s.points[s.mesh.from(h) == v ? s.mesh.to(h) : s.mesh.from(h)];
  const Place place = s.reference->walk.slide(s.place[v], from + at * (s.points[v] - from));
  const Vec3 p = s.reference->walk.point(place);
  const std::vector<CopyPlace> places = copies_at(s, v, place, p);
  for (const CopyPlace& c : places) {
    put(s, c.at, c.place, p, c.normal);
    s.hold[c.at] = fixed;
    mark_edited(s, c.at);
  }
  s.schedule.listed = false;
  return !places.empty();
}

/// Lets an anchored vertex go (`at` 1), or moves it by a share of a step of smoothing and holds it there.
bool release(State& s, int v, double at) {
  const Vec3 p = s.points[v];
  s.hold[v] = loose;
  const bool moves = at == 1 || move_vertex(s, v);
  if (at < 1) s.hold[v] = anchored;
  if (at < 1 && moves) {
    const Place place = s.reference->walk.closest(s.place[v], lerp(p, s.points[v], at));
    put(s, v, place, s.reference->walk.point(place), s.reference->normal(place));
  }
  mark_edited(s, v);
  return moves;
}

/// May a trial take a vertex of the edge of h out? Those of lines are as the lines ask for.
bool may_thin(const State& s, int h) {
  return s.mesh.opp[h] < 0 ? s.acute && !s.keep_border : !s.mesh.hard[h];
}

/// Makes a change if it may be made; else nothing is changed.
bool try_edit(State& s, const Edit& edit, bool may_fold) {
  if (edit.kind == Edit::split)
    return split_edge(s, edit.h, edit.at) || (may_fold && split_edge(s, edit.h, edit.at, true));
  if (edit.kind == Edit::release) return release(s, edit.end, edit.at);
  if (edit.kind == Edit::reach) return reach(s, edit);
  if (edit.kind == Edit::slide) return slide_end(s, edit.h, edit.end, edit.at);
  if (edit.kind == Edit::collapse)
    return (may_fold || may_thin(s, edit.h) || is_shared(s, edit.end)) &&
           collapse_edge(s, edit.h, edit.end, may_fold ? rules::at_fault : rules::on_trial);
  const bool may = may_flip(s, edit.h);
  if (may) flip_edge(s, edit.h);
  return may;
}

/// Splits of model edges of t (`all`: of any) where an end of its other edges is as near as possible:
/// opposite to its third corner, and as far from each end as that is. Segments of lines that are closer to
/// each other than they are long must be divided alike.
void add_aligned_splits(const State& s, int t, bool all, std::vector<Edit>& edits) {
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    if (!all && !s.mesh.hard[h]) continue;
    const Vec3 a = s.points[s.mesh.from(h)], b = s.points[s.mesh.to(h)], c = s.points[s.mesh.apex(h)];
    const double l = norm(b - a), foot = dot(c - a, b - a) / (l * l);
    for (double at : {foot, norm(c - a) / l, 1 - norm(c - b) / l})
      if (at > rules::least_piece && at < 1 - rules::least_piece) edits.push_back({Edit::split, h, -1, at});
  }
}

/// Slides of the ends of two model edges that meet at a corner in a sharp angle: kappa of t is best if both
/// are as far from the corner.
void add_slides_at_corners(const State& s, int t, std::vector<Edit>& edits) {
  const EditMesh& m = s.mesh;
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    const int corner = m.from(h), g = prev(h), ends[] = {m.to(h), m.from(g)};
    if (!m.hard[h] || !m.hard[g] || s.hold[corner] != fixed) continue;
    const Vec3 a = s.points[ends[0]] - s.points[corner], b = s.points[ends[1]] - s.points[corner];
    if (angle(a, b) > rules::sharp_turn) continue;
    if (s.hold[ends[0]] == slides) edits.push_back({Edit::slide, h, ends[0], norm(b) / norm(a)});
    if (s.hold[ends[1]] == slides) edits.push_back({Edit::slide, g, ends[1], norm(a) / norm(b)});
  }
}

/// The flips, splits and collapses of the edges of t and of its neighbors; `wide`: of all that touch it.
std::vector<Edit> edits_around(const State& s, int t, bool wide, const Judge& judge) {
  const EditMesh& m = s.mesh;
  std::vector<int> halfedges;
  for (int u : wide ? triangles_around(s, t, 1) : std::vector<int>{t})
    for (int h = 3 * u; h < 3 * u + 3; ++h) {
      const int g = m.opp[h];
      if (!wide || g < h) halfedges.push_back(h);
      if (!wide && g >= 0) halfedges.insert(halfedges.end(), {next(g), prev(g)});
    }
  std::vector<Edit> edits;
  if (judge.may_fold) edits = edits_to_bends(s, t);
  add_aligned_splits(s, t, judge.may_fold, edits);
  add_slides_at_corners(s, t, edits);
  for (int h = 3 * t; h < 3 * t + 3; ++h)
    if (s.acute && !judge.may_fold && s.hold[m.from(h)] == anchored)
      for (double at : rules::releases) edits.push_back({Edit::release, h, m.from(h), at});
  for (int h : halfedges) {
    edits.push_back({Edit::collapse, h, m.from(h)});
    edits.push_back({Edit::collapse, h, m.to(h)});
    edits.push_back({Edit::split, h});
    if (!m.hard[h]) edits.push_back({Edit::flip, h});
  }
  return edits;
}

/// Tries each edit on a copy of `from`, where only what it disturbs moves; at faults also none, where all
/// moves. All are smoothed once, the better third settles a little, and the best of them quite.
std::vector<Trial> try_all(State from, const std::vector<Edit>& edits, const Judge& judge) {
  std::vector<Trial> trials;
  if (judge.may_fold) {
    trials.push_back({0, from});
    settle(trials.back().state, rules::sweeps_to_settle);
  }
  rest(from);
  std::vector<std::optional<State>> edited(edits.size());
  parallel_for((int)edits.size(), [&](int i) {
    State copy = from;
    if (!try_edit(copy, edits[i], judge.may_fold)) return;
    flip_to_shape(copy);
    smooth(copy, 1);
    edited[i] = std::move(copy);
  });
  for (std::optional<State>& state : edited)
    if (state) trials.push_back({0, std::move(*state)});
  keep_best(trials, std::max(rules::promising, (int)(rules::promising_at_once * (double)trials.size())),
            judge);
  parallel_for((int)trials.size(), [&](int i) { smooth(trials[i].state, rules::sweeps_to_settle - 1); });
  keep_best(trials, rules::promising, judge);
  for (Trial& t : trials) settle(t.state, 1);
  keep_best(trials, rules::promising, judge);
  return trials;
}

/// Is the mesh still near to the features at which vertices of it were anchored before?
bool stays_near(const State& before, const State& after) {
  for (int v = 0; v < (int)before.hold.size(); ++v) {
    const Vec3 p = before.points[v];
    if (before.hold[v] != anchored || (after.mesh.out[v] >= 0 && after.points[v] == p)) continue;
    double least = 1e300;
    for (int t = 0; t < (int)after.mesh.tris.size(); ++t)
      if (!after.mesh.dead(t)) least = std::min(least, norm(nearest_point(after, t, p) - p));
    if (least > rules::missed * before.target(v)) return false;
  }
  return true;
}

/// Was a change tried at the first of these triangles without success, when their edges were what they are?
/// Triangles that only sweeps have moved since are as they were.
bool failed_before(const State& s, const std::vector<int>& failed, const std::vector<int>& triangles) {
  const int t = triangles.front(), then = t < (int)failed.size() ? failed[t] : 0;
  auto unedited = [&](int u) {
    const Tri& v = s.mesh.tris[u];
    return std::all_of(v.begin(), v.end(), [&](int w) { return s.clocks.edited[w] < then; });
  };
  return then > 0 && std::all_of(triangles.begin(), triangles.end(), unedited);
}

bool is_needle(const State& s, int t) {
  const auto [a, b, c] = s.mesh.tris[t];
  return kappa(s.points[a], s.points[b], s.points[c]) <= rules::bearable_kappa;
}

/// Repairs at each of these triangles, as long as it is wanted; returns the number of changes. With `most`
/// triangles no more are added, except where one is a needle.
template <class Wanted>
int repair_each(State& s, std::vector<int> triangles, bool thorough, Repairs& memory, int most,
                Wanted wanted) {
  std::vector<int>& failed = memory.failed[thorough];
  auto around = [&](int t, std::vector<int> found) -> std::vector<int> {
    if (s.mesh.dead(t) || !wanted(t)) return {};
    if (found.empty()) found = triangles_around(s, t, thorough ? rules::thorough_rings : rules::rings);
    if ((int)found.size() > rules::largest_patch || failed_before(s, failed, found)) return {};
    return found;
  };
  auto attempt = [&](int t, const std::vector<int>& patch) {
    auto better = repaired(s, patch, thorough);
    if (better && s.mesh.live >= most && better->mesh.live > (int)patch.size() && !is_needle(s, t))
      better.reset();
    return better;
  };
  auto remember = [&](const std::vector<int>& patch) {
    failed.resize(s.mesh.tris.size());
    failed[patch.front()] = s.clocks.now;
    memory.in_vain += thorough;
  };
  return change_neighborhoods(s, triangles, INT_MAX, INT_MAX, around, attempt, remember);
}

/// The triangles that are not good enough and have changed after `since`, the worst first.
std::vector<int> bad_triangles(const State& s, Repairs& memory, int since) {
  const int n = (int)s.mesh.tris.size(), before = (int)memory.quality.size();
  memory.quality.resize(n);
#pragma omp parallel for schedule(dynamic, 1024) if (n > 10000)
  for (int t = 0; t < n; ++t)
    if (!s.mesh.dead(t) && (t >= before || changed_since(s, t, memory.time)))
      memory.quality[t] = quality(s, t);
  memory.time = s.clocks.now;
  std::vector<std::pair<double, int>> bad;
  for (int t = 0; t < n; ++t)
    if (!s.mesh.dead(t) && memory.quality[t] < 1 && changed_since(s, t, since))
      bad.push_back({memory.quality[t], t});
  std::sort(bad.begin(), bad.end());
  std::vector<int> triangles;
  for (auto [q, t] : bad) triangles.push_back(t);
  return triangles;
}

}  // namespace

std::optional<State> repaired(const State& s, const std::vector<int>& triangles, bool thorough,
                              const Judge& given) {
  if (has_double_edge(s.mesh, triangles)) return {};
  const State before = extract(s, triangles);
  Judge judge = given;
  if (s.acute && !given.may_fold)
    judge.of = [&](const State& patch, double bound) {
      return stays_near(before, patch) ? given.of(patch, bound) : infinity;
    };
  const double bad = judge.of(before, infinity),
               good_enough = bad - std::min(rules::gain_share * bad, rules::gain);
  std::vector<Edit> edits;
  for (int t = 0; t < judge.at; ++t) {
    const std::vector<Edit> more = edits_around(before, t, thorough, judge);
    edits.insert(edits.end(), more.begin(), more.end());
  }
  const std::vector<Trial> trials = try_all(before, edits, judge);
  if (trials.empty()) return {};
  Trial best = trials.front();
  for (std::size_t i = 0; i < rules::promising_pairs && i < trials.size() && thorough; ++i) {
    if (best.objective <= good_enough) break;
    const State& from = trials[i].state;
    for (Trial& second : try_all(from, edits_around(from, worst(from), false, judge), judge))
      if (second.objective < best.objective) best = std::move(second);
  }
  if (best.objective > good_enough) return {};
  return std::move(best.state);
}

void repair_worst(State& s, Repairs& memory, int since, int most_live) {
  const int most = rules::repairs + s.mesh.live / rules::triangles_per_repair;
  int before = 0, first = 0;
  if (memory.time < 0) {
    s.acute = true;
    s.acute = (double)bad_triangles(s, memory, -1).size() <= rules::few_bad * s.mesh.live;
    if (!s.acute) memory.quality.clear();
  }
  for (int round = 0; round < (memory.forced ? 1 : rules::repair_rounds); ++round) {
    std::vector<int> triangles = bad_triangles(s, memory, since), irregular;
    const int count = (int)triangles.size();
    if (round == 0) first = count;
    if (round > 1 && count > rules::hopeless) {
      memory.forced = memory.forced || count > rules::forced_share * first;
      if (count > rules::same_share * before) return;
    }
    before = count;
    // far more than can be repaired: then there is time for fewer
    int few = count > 4 * most ? most / 2 : most;
    if (round > 0)
      few = std::clamp(rules::thorough_repairs + s.mesh.live / rules::triangles_per_thorough - memory.in_vain,
                       0, few);
    if (count > few) triangles.resize(few);
    const bool done = triangles.empty();
    int changes = repair_each(s, std::move(triangles), round > 0, memory, most_live,
                              [&](int t) { return quality(s, t) < 1; });
    for (int v = 0; v < (int)s.mesh.out.size() && (int)irregular.size() < most; ++v)
      if (s.clocks.changed[v] > since && irregularity(s, v)) irregular.push_back(s.mesh.out[v] / 3);
    if (done && irregular.empty()) return;
    changes += repair_each(s, std::move(irregular), false, memory, most_live, [&](int t) {
      const Tri& v = s.mesh.tris[t];
      return irregularity(s, v[0]) + irregularity(s, v[1]) + irregularity(s, v[2]) > 0;
    });
    if (round > 0 && changes == 0) return;
  }
}

}  // namespace meshpipe
