// SPDX-License-Identifier: BSD-3-Clause
// Cuts every part that is too long, until none is.
#include <algorithm>
#include <set>
#include <string>

#include "lib/core/cut.h"
#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/neighborhood.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/partition/partition.h"
#include "lib/plan/plan.h"

namespace meshpipe {
namespace {

/// A surface with its parts, as far as they are cut.
struct Work {
  Surface& surface;
  const MultiscaleOptions& options;
  std::vector<MultiscaleCut>* cuts;
  std::vector<int> opposite;
  std::vector<Topology> is;           ///< of each part, as it was before its neighbors were cut
  std::vector<char> was_cut;          ///< of each part
  std::vector<std::set<int>> near{};  ///< of each part: those that share a vertex with it
  bool current = true;                ///< has no neighbor been cut, and no part joined?
  int parts() const { return (int)is.size(); }
};

/// A neighborhood with its part cut in two.
struct Halves {
  Surface surface;
  std::vector<int> opposite, side;
  std::vector<Topology> is;
  int loops = 0;  ///< of both together; 0 if they are not parts as the stream wants them
};

/// Measures the two sides of a cut.
void measure_halves(Halves& halves) {
  try {
    halves.is = topology_of_parts({halves.surface, halves.opposite}, halves.side, 2);
  } catch (const NotAdmissible&) {  // a pinched vertex, where the line was snapped to one twice
    return;
  }
  if (admissible(halves.is[0], infinity) && admissible(halves.is[1], infinity))
    halves.loops = halves.is[0].loops + halves.is[1].loops;
}

/// Cuts the active triangles of a neighborhood, those of the part, along the zero level of its field, pulled
/// straight. A line that is snapped to vertices may touch itself there: then it is snapped less, until the
/// halves have no more loops than expected. On a few coarse triangles it may be pulled off the part: at last
/// it stays as it is.
Halves split(const Neighborhood& near, const ConnectedPart& part, const std::vector<double>& field,
             const std::vector<char>& active, int expected_loops) {
  using Pull = std::pair<double, int>;
  const LevelLine level = zero_level(part, field);
  const std::vector<LineVertex> hold(field.size(), LineVertex::moves);
  Halves best;
  for (auto [snap, sweeps] : {Pull{0.1, 60}, Pull{0.03, 30}, Pull{0.01, 30}, Pull{0, 30}, Pull{0, 0}}) {
    LevelLine line = level;
    pull_straight({part, part.opposite}, line, hold, snap, sweeps);
    Halves trial{near.surface, near.opposite, {}, {}};
    cut_along_line({trial.surface, trial.opposite}, in_whole(line, part.vertex, near.surface.points.size()),
                   active, trial.side);
    measure_halves(trial);
    if (trial.loops == 0 || (best.loops > 0 && trial.loops >= best.loops)) continue;
    best = std::move(trial);
    if (best.loops <= expected_loops) break;
  }
  return best;
}

/// A part that is to be cut.
struct Task {
  int part, depth;
  double share;         ///< of the work, as predicted
  Neighborhood near{};  ///< once the cut is found: with the part cut
  Halves made{};        ///< without loops if the part cannot be cut
  MultiscaleCut cut{};
};
constexpr double once = 2. / 3;  // of what a cut is predicted to take; the rest is for cutting its halves

/// Finds the cut of a part in its neighborhood.
void find_cut(Work& work, Task& task) {
  Neighborhood& near = task.near;
  near = take_neighborhood({work.surface, work.opposite}, work.surface.face.get<int>("part"), task.part);
  const ConnectedPart part =
      select_part({near.surface, near.opposite}, near.surface.face.get<int>("part"), task.part);
  std::vector<char> active(near.face.size(), 0);
  for (int t : part.face) active[t] = 1;
  std::vector<double> field;
  CutMaps maps = best_cut(part, once * task.share, field);
  const Assessment expected = assess(part, field);
  task.cut.eta = work.is[task.part].eta_geo;
  task.cut.levels = (int)maps.levels.size();
  task.cut.length = expected.length / diagonal(part);
  if (work.options.keep_maps) task.cut.maps = std::move(maps);
  if (expected.valid) task.made = split(near, part, field, active, expected.loops);
  near.surface = std::move(task.made.surface);
  near.opposite = std::move(task.made.opposite);
}

/// Finds the cuts of the next tasks, the last first, of parts that share no vertex with one before them.
void find_cuts(Work& work, std::vector<Task>& tasks) {
  constexpr int most = 32;  // as their neighborhoods take memory
  std::vector<char> before(work.parts(), 0);
  std::vector<int> next;
  for (int i = (int)tasks.size() - 1; i >= 0 && i >= (int)tasks.size() - most; --i) {
    const std::set<int>& near = work.near[tasks[i].part];
    if (tasks[i].near.face.empty() &&
        std::none_of(near.begin(), near.end(), [&](int p) { return before[p]; }))
      next.push_back(i);
    before[tasks[i].part] = 1;
  }
  parallel_for((int)next.size(), [&](int i) { find_cut(work, tasks[next[i]]); });
}

/// Cuts one part in two; adds the tasks of halves that are still too long. Nothing if it cannot be cut.
void cut_part(Work& work, Task& task, std::vector<Task>& tasks) {
  const Halves& made = task.made;
  if (made.loops == 0) return;
  const int other = work.parts();
  task.cut.part = task.cut.halves[0] = task.part;
  task.cut.halves[1] = other;
  if (work.cuts) work.cuts->push_back(std::move(task.cut));
  std::vector<int>& label = task.near.surface.face.get<int>("part");
  for (std::size_t t = 0; t < label.size(); ++t)
    if (made.side[t] == 1) label[t] = other;
  put_back(task.near, {work.surface, work.opposite});
  work.is.resize(other + 1), work.was_cut.resize(other + 1, 0);
  work.current &= work.near[task.part].empty();
  work.near.push_back(work.near[task.part]);
  work.near[other].insert(task.part);
  for (int p : work.near[other]) work.near[p].insert(other);
  add_progress(0.3 * once * task.share);
  for (int s : {0, 1}) {
    const int half = s ? other : task.part;
    const double share = (1 - once) / 2 * task.share;
    work.was_cut[half] = 1;
    work.is[half] = made.is[s];
    if (work.is[half].eta_geo > work.options.max_aspect && task.depth + 1 < limit::cut_depth)
      tasks.push_back({half, task.depth + 1, share});
    else
      add_progress(share);
  }
}

/// Returns for each part those that share a vertex with it.
std::vector<std::set<int>> near_parts(const Work& work) {
  const std::vector<int>& label = work.surface.face.get<int>("part");
  std::vector<std::set<int>> near(work.parts());
  for (int h = 0; h < (int)label.size() * 3; ++h)
    if (const int o = work.opposite[h], mine = label[h / 3]; o >= 0 && mine >= 0 && label[o / 3] != mine)
      for (int end : {h, next(h)})
        for_each_spoke(work.opposite, end, [&](int g) {
          if (const int p = label[g / 3]; p >= 0 && p != mine) near[mine].insert(p);
        });
  return near;
}

/// Joins neighbors one of which was cut here while the union is admissible: a ring's two long arcs, each cut
/// lengthwise, make two flat rings.
void join_parts(Work& work) {
  Surface& s = work.surface;
  std::vector<int>& label = s.face.get<int>("part");
  if (*std::min_element(label.begin(), label.end()) < 0) return;  // only some of the parts are given
  const int n_before = work.parts();
  const int n_tris = (int)s.tris.size(),
            most_faces = n_tris > limit::large_component ? limit::faces_of_large : n_tris;
  const Connectivity mesh{s, work.opposite, model_of(s)};
  Joiner joiner(mesh, label, find_regions(mesh, label, n_before));
  std::vector<std::vector<int>> faces(n_before);  // of each part
  for (int t = 0; t < n_tris; ++t) faces[label[t]].push_back(t);
  std::vector<int> becomes = identity(n_before), numbers(s.points.size(), -1);
  auto length = [&](int h) { return mesh.length(h); };
  const bool any = join_neighbors(joiner, mesh, label, length, [&](int a, int b) {
    if (!work.was_cut[a] && !work.was_cut[b]) return false;
    if (std::any_of(joiner.regions().border[a].begin(), joiner.regions().border[a].end(), [&](int h) {
          return mesh.is_model(h) && mesh.opposite[h] >= 0 && label[mesh.opposite[h] / 3] == b;
        }))
      return false;
    const Region r = joiner.joined(a, b);
    if (!r.maps_to_the_plane() || r.aspect() > 2 * work.options.max_aspect || r.faces > most_faces)
      return false;
    std::vector<int> both;
    std::merge(faces[a].begin(), faces[a].end(), faces[b].begin(), faces[b].end(), std::back_inserter(both));
    if (!admissible(topology_of(sub_mesh(s, both, numbers)), work.options.max_aspect)) return false;
    faces[a] = std::move(both);
    std::replace(becomes.begin(), becomes.end(), b, a);
    return true;
  });
  if (!any) return;
  std::vector<int> number(n_before, -1);
  int n = 0;
  for (int p = 0; p < n_before; ++p)
    if (becomes[p] == p) number[p] = n++;
  for (int& l : label) l = number[l];
  if (work.cuts)
    for (MultiscaleCut& c : *work.cuts)
      for (int* p : {&c.part, &c.halves[0], &c.halves[1]}) *p = number[becomes[*p]];
  work.is.assign(n, {});
  work.current = false;
}

}  // namespace

int multiscale_cut(Surface& surface, const MultiscaleOptions& options, std::vector<MultiscaleCut>* cuts,
                   std::vector<Topology>* topology, std::vector<int>* neighbors) {
  const std::vector<int>& given = surface.face.get<int>("part");
  const int given_parts = given.empty() ? 0 : *std::max_element(given.begin(), given.end()) + 1;
  const bool known = neighbors && !neighbors->empty();
  Work work{surface, options, cuts, known ? std::move(*neighbors) : opposite_halfedges(surface), {}, {}};
  if (topology) work.is = std::move(*topology);
  if (work.is.empty()) work.is = topology_of_parts({surface, work.opposite}, given, given_parts);
  work.was_cut.assign(given_parts, 0);
  std::vector<Task> tasks;
  double faces = 0;
  for (int p = given_parts - 1; p >= 0; --p) {
    const Topology& t = work.is[p];
    if (!admissible(t, infinity))
      throw NotAdmissible("part " + std::to_string(p) + " has " + std::to_string(t.components) +
                          " components, genus " + std::to_string(t.genus) + " and " +
                          std::to_string(t.loops) +
                          " boundary loops where 1, 0 and at least 1 are needed; run mpartition first");
    if (t.eta_geo > options.max_aspect) {
      tasks.push_back({p, 0, (double)t.faces});
      faces += (double)t.faces;
    }
  }
  if (!tasks.empty()) name_origins(surface);
  work.near = near_parts(work);
  add_progress(0.05);
  for (Task& t : tasks) t.share *= 0.9 / faces;
  while (!tasks.empty()) {
    if (tasks.back().near.face.empty()) find_cuts(work, tasks);
    Task task = std::move(tasks.back());
    tasks.pop_back();
    if (options.most_parts > 0 && work.parts() >= options.most_parts)
      throw GoalMissed("more than " + std::to_string(options.most_parts) +
                       " parts are needed for aspect ratios below " + std::to_string(options.max_aspect));
    cut_part(work, task, tasks);
  }
  if (work.parts() > std::max(given_parts, 2)) join_parts(work);
  if (topology && !work.current)
    work.is = topology_of_parts({surface, work.opposite}, surface.face.get<int>("part"), work.parts());
  if (topology) *topology = work.is;
  if (neighbors) *neighbors = std::move(work.opposite);
  return work.parts();
}

}  // namespace meshpipe
