// SPDX-License-Identifier: BSD-3-Clause
// Cuts every part that is too long, until none is.
#include <algorithm>
#include <numeric>
#include <string>

#include "lib/core/cut.h"
#include "lib/core/error.h"
#include "lib/core/neighborhood.h"
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
  std::vector<Topology> is;   ///< of each part
  std::vector<char> was_cut;  ///< of each part
  int parts() const { return (int)is.size(); }
};

/// A part that is to be cut.
struct Task {
  int part, depth;
  double share;  ///< of the work, as predicted
};

/// A neighborhood with its part cut in two.
struct Halves {
  Surface surface;
  std::vector<int> opposite, side;
  std::vector<Topology> is;
  int loops = 0;  ///< of both together; 0 if they are not parts as the stream wants them
};

std::string name(int part) { return "part " + std::to_string(part); }

bool is_disk_with_holes(const Topology& t) { return t.components == 1 && t.genus == 0 && t.loops >= 1; }

/// Measures the two sides of a cut.
void measure_halves(Halves& halves) {
  try {
    halves.is = topology_of_parts({halves.surface, halves.opposite}, halves.side, 2);
  } catch (const NotAdmissible&) {  // a pinched vertex, where the line was snapped to one twice
    return;
  }
  if (is_disk_with_holes(halves.is[0]) && is_disk_with_holes(halves.is[1]))
    halves.loops = halves.is[0].loops + halves.is[1].loops;
}

/// Cuts the active triangles of a neighborhood, those of the part, along the zero level of its field, pulled
/// straight. A line that is snapped to vertices may touch itself there: then it is snapped less, until the
/// halves have no more loops than expected. On a few coarse triangles it may be pulled off the part: at last
/// it stays as it is.
Halves split(const Neighborhood& near, const ConnectedPart& part, const std::vector<double>& field,
             const std::vector<char>& active, int expected_loops) {
  struct Pull {
    double snap;
    int sweeps;
  };
  const LevelLine level = zero_level(part, field);
  const std::vector<Hold> hold(field.size(), Hold::moves);
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

/// The triangles of one part with its connectivity; marks them in `active`.
ConnectedPart take_part(const Neighborhood& near, int p, std::vector<char>& active) {
  const std::vector<int>& label = near.surface.face.get<int>("part");
  active.resize(label.size());
  for (std::size_t t = 0; t < label.size(); ++t) active[t] = label[t] == p;
  return select_part({near.surface, near.opposite}, label, p);
}

/// Cuts one part in two; adds the tasks of halves that are still too long. Nothing if it cannot be cut.
void cut_part(Work& work, const Task& task, std::vector<Task>& tasks) {
  constexpr double once = 2. / 3;  // of what a cut is predicted to take; the rest is for cutting its halves
  const MultiscaleOptions& options = work.options;
  std::vector<char> active;
  Neighborhood near =
      take_neighborhood({work.surface, work.opposite}, work.surface.face.get<int>("part"), task.part);
  const ConnectedPart part = take_part(near, task.part, active);
  MultiscaleCut cut;
  cut.part = task.part;
  cut.halves[0] = task.part;
  cut.halves[1] = work.parts();
  cut.eta = work.is[task.part].eta_geo;
  std::vector<double> field;
  CutMaps maps = best_cut(part, once * task.share, field);
  cut.levels = (int)maps.levels.size();
  const Assessment expected = assess(part, field);
  cut.length = expected.length / diagonal(part);
  if (options.keep_maps) cut.maps = std::move(maps);
  Halves made;
  if (expected.valid) made = split(near, part, field, active, expected.loops);
  if (made.loops == 0) return;
  if (work.cuts) work.cuts->push_back(cut);
  const int other = work.parts();
  near.surface = std::move(made.surface);
  near.opposite = std::move(made.opposite);
  std::vector<int>& label = near.surface.face.get<int>("part");
  for (std::size_t t = 0; t < label.size(); ++t)
    if (made.side[t] == 1) label[t] = other;
  put_back(near, {work.surface, work.opposite});
  work.is.resize(other + 1);
  work.was_cut.resize(other + 1, 0);
  add_progress(0.3 * once * task.share);
  for (int s : {0, 1}) {
    const int half = s ? other : task.part;
    const double share = (1 - once) / 2 * task.share;
    work.was_cut[half] = 1;
    work.is[half] = made.is[s];
    if (work.is[half].eta_geo > options.max_aspect)
      tasks.push_back({half, task.depth + 1, share});
    else
      add_progress(share);
  }
}

/// Joins neighbors one of which was cut here while the union is admissible: a ring's two long arcs, each cut
/// lengthwise, make two flat rings.
void join_parts(Work& work) {
  Surface& s = work.surface;
  std::vector<int>& label = s.face.get<int>("part");
  if (*std::min_element(label.begin(), label.end()) < 0) return;  // only some of the parts are given
  const int n_before = work.parts();
  const double max_aspect = work.options.max_aspect;
  const int faces = (int)s.tris.size(),
            most_faces = faces > limit::large_component ? limit::faces_of_large : faces;
  const Connectivity mesh{s, work.opposite, model_of(s)};
  Joiner joiner(mesh, label, find_regions(mesh, label, n_before));
  std::vector<int> becomes(n_before);
  std::iota(becomes.begin(), becomes.end(), 0);
  auto length = [&](int h) { return norm(s.points[target(s.tris, h)] - s.points[origin(s.tris, h)]); };
  const bool any = join_neighbors(joiner, mesh, label, length, [&](int a, int b) {
    if (!work.was_cut[a] && !work.was_cut[b]) return false;
    if (std::any_of(joiner.regions().border[a].begin(), joiner.regions().border[a].end(), [&](int h) {
          return mesh.is_model(h) && mesh.opposite[h] >= 0 && label[mesh.opposite[h] / 3] == b;
        }))
      return false;
    const Region r = joiner.joined(a, b);
    if (!r.maps_to_the_plane() || r.aspect() > 2 * max_aspect || r.faces > most_faces) return false;
    std::vector<int> both(label.size());
    for (std::size_t t = 0; t < both.size(); ++t) both[t] = label[t] == a || label[t] == b ? 0 : -1;
    if (!admissible(topology_of_parts({s, work.opposite}, both, 1)[0], max_aspect)) return false;
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
}

/// The parts' topology, found again for those whose triangles are not as many as they were: a cut splits
/// those of its neighbors.
std::vector<Topology> refreshed(const Work& work) {
  std::vector<Topology> is = work.is;
  std::vector<int> label = work.surface.face.get<int>("part"), faces(is.size(), 0);
  for (int l : label)
    if (l >= 0) ++faces[l];
  for (int& l : label)
    if (l >= 0 && faces[l] == is[l].faces) l = -1;
  if (std::all_of(label.begin(), label.end(), [](int l) { return l < 0; })) return is;
  std::vector<Topology> changed = topology_of_parts({work.surface, work.opposite}, label, (int)is.size());
  for (std::size_t p = 0; p < is.size(); ++p)
    if (changed[p].faces > 0) is[p] = std::move(changed[p]);
  return is;
}

}  // namespace

int multiscale_cut(Surface& surface, const MultiscaleOptions& options, std::vector<MultiscaleCut>* cuts,
                   std::vector<Topology>* topology, std::vector<int>* neighbors) {
  const std::vector<int>& given = surface.face.get<int>("part");
  const int given_parts = given.empty() ? 0 : *std::max_element(given.begin(), given.end()) + 1;
  Work work{surface, options, cuts, opposite_halfedges(surface), {}, {}};
  work.is = topology_of_parts({surface, work.opposite}, given, given_parts);
  work.was_cut.assign(given_parts, 0);
  std::vector<Task> tasks;
  double faces = 0;
  for (int p = given_parts - 1; p >= 0; --p) {
    const Topology& t = work.is[p];
    if (!is_disk_with_holes(t))
      throw NotAdmissible(name(p) + " has " + std::to_string(t.components) + " components, genus " +
                          std::to_string(t.genus) + " and " + std::to_string(t.loops) +
                          " boundary loops where 1, 0 and at least 1 are needed; run mpartition first");
    if (t.eta_geo > options.max_aspect) {
      tasks.push_back({p, 0, (double)t.faces});
      faces += (double)t.faces;
    }
  }
  if (!tasks.empty()) name_origins(surface);
  constexpr double before = 0.05, all = 0.9;  // of the work
  add_progress(before);
  for (Task& t : tasks) t.share *= all / faces;
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (task.depth >= limit::cut_depth) continue;  // cuts do not make it shorter
    if (options.most_parts > 0 && work.parts() >= options.most_parts)
      throw GoalMissed("more than " + std::to_string(options.most_parts) +
                       " parts are needed for aspect ratios below " + std::to_string(options.max_aspect));
    cut_part(work, task, tasks);
  }
  if (work.parts() > std::max(given_parts, 2)) join_parts(work);
  if (topology) *topology = refreshed(work);
  if (neighbors) *neighbors = std::move(work.opposite);
  return work.parts();
}

}  // namespace meshpipe
