// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>
#include <tuple>

#include "lib/balance.h"
#include "lib/coarsen.h"
#include "lib/cut.h"
#include "lib/cut_line.h"
#include "lib/error.h"
#include "lib/levels.h"
#include "lib/maxcut.h"
#include "lib/parallel.h"
#include "lib/progress.h"
#include "lib/regions.h"
#include "lib/sliver.h"
#include "lib/straighten.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

constexpr int max_depth = 12;         // of cuts within one part of the input
constexpr double least_share = 0.02;  // of the area: a smaller half is no progress

/// What the zero level of a field does to a part.
struct Assessment {
  bool valid = false;        ///< both sides there, each in one piece
  int loops = 0;             ///< of both halves together; 2 for two disks
  double length = 0;         ///< of the cut
  double smaller_share = 0;  ///< of the area
};

/// A part of genus 0.
struct Part {
  Mesh mesh;
  std::vector<int> vertex;  ///< its vertices in the whole
  std::vector<int> opposite;
  std::vector<char> crease;  ///< of half-edges: model edges inside the part; empty if there are none
};

/// Face column `model` of the part; empty if there is none.
std::vector<std::uint8_t> model_of(const Surface& surface, const SubMesh& part) {
  std::vector<std::uint8_t> model;
  if (!surface.face.has("model")) return model;
  for (int t : part.face) model.push_back(surface.face.get<std::uint8_t>("model")[t]);
  return model;
}

int root_of(std::vector<int>& parent, int v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

/// Pieces of a side other than its largest go to the other side: afterwards each side is in one piece.
/// Pieces are those of the vertices of one sign under the edges between them; the side that the cut makes has
/// the same connectivity and the same Euler characteristic, for no value is zero.
void drop_fragments(const Part& part, std::vector<double>& field) {
  const std::vector<Tri>& tris = part.mesh.tris;
  std::vector<int> parent(field.size()), size, fragments;
  for (bool positive : {true, false}) {
    std::iota(parent.begin(), parent.end(), 0);
    size.assign(field.size(), 0);
    for (const Tri& t : tris)
      for (int k = 0; k < 3; k++) {
        int a = t[k], b = t[(k + 1) % 3];
        if ((field[a] > 0) != (field[b] > 0)) continue;
        int ra = root_of(parent, a), rb = root_of(parent, b);
        if (ra != rb) parent[std::max(ra, rb)] = std::min(ra, rb);
      }
    int largest = -1;
    for (std::size_t v = 0; v < field.size(); v++) {
      if ((field[v] > 0) != positive) continue;
      int r = root_of(parent, v);
      if (++size[r]; largest < 0 || size[r] > size[largest]) largest = r;
    }
    fragments.clear();
    for (std::size_t v = 0; v < field.size(); v++)
      if ((field[v] > 0) == positive && root_of(parent, v) != largest) fragments.push_back(v);
    for (int v : fragments) field[v] = -field[v];
  }
}

Assessment assess(const Part& part, const std::vector<double>& field) {
  const std::vector<Vec3>& p = part.mesh.points;
  Assessment a;
  int chi[2] = {0, 0};
  double area[2] = {0, 0};
  std::vector<int> parent(field.size());
  std::iota(parent.begin(), parent.end(), 0);
  int pieces = field.size();
  for (double f : field) chi[f > 0]++;
  if (chi[0] == 0 || chi[1] == 0) return a;
  for (std::size_t t = 0; t < part.mesh.tris.size(); t++) {
    const Tri& c = part.mesh.tris[t];
    const double third = norm(area_vector(p[c[0]], p[c[1]], p[c[2]])) / 6;
    Vec3 crossing[2];
    int crossings = 0, positive = 0;
    for (int k = 0; k < 3; k++) {
      const int u = c[k], v = c[(k + 1) % 3], h = 3 * t + k;
      positive += field[u] > 0;
      area[field[u] > 0] += third;
      if ((field[u] > 0) != (field[v] > 0)) {
        crossing[crossings++ & 1] = lerp(p[u], p[v], field[u] / (field[u] - field[v]));
        continue;
      }
      if (part.opposite[h] > h) continue;  // every edge once
      chi[field[u] > 0]--;
      int ru = root_of(parent, u), rv = root_of(parent, v);
      if (ru == rv) continue;
      parent[std::max(ru, rv)] = std::min(ru, rv);
      pieces--;
    }
    if (crossings == 2) a.length += norm(crossing[1] - crossing[0]);
    if (positive % 3 == 0) chi[positive == 3]++;
  }
  a.valid = pieces == 2;
  a.loops = 4 - chi[0] - chi[1];
  a.smaller_share = std::min(area[0], area[1]) / (area[0] + area[1]);
  return a;
}

/// Fewest holes left, then a short cut between halves of like size.
bool better(const Assessment& a, const Assessment& b) {
  if (a.valid != b.valid) return a.valid;
  if (a.loops != b.loops) return a.loops < b.loops;
  auto cost = [](const Assessment& x) { return x.length * (1 + 4 * std::max(0., 0.3 - x.smaller_share)); };
  return cost(a) < cost(b);
}

/// The last resort: across the part, half way from its rim to its farthest vertex. It always shortens the
/// part.
std::vector<double> across(const Part& part, const std::vector<int>& rim) {
  std::vector<double> distance(part.mesh.points.size(), 1e300);
  std::vector<int> start(distance.size() + 1, 0), edges(3 * part.mesh.tris.size());
  for (const Tri& t : part.mesh.tris)
    for (int v : t) start[v + 1]++;
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> fill(start.begin(), start.end() - 1);
  for (std::size_t h = 0; h < edges.size(); h++) edges[fill[origin(part.mesh.tris, h)]++] = h;
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (int v : rim) queue.push({distance[v] = 0, v});
  double farthest = 0;
  while (!queue.empty()) {
    auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v]) continue;
    farthest = d;
    for (int i = start[v]; i < start[v + 1]; i++)
      for (int w : {target(part.mesh.tris, edges[i]), origin(part.mesh.tris, prev(edges[i]))})
        if (double e = d + norm(part.mesh.points[w] - part.mesh.points[v]); e < distance[w])
          queue.push({distance[w] = e, w});
  }
  for (double& d : distance) {
    d -= farthest / 2;
    if (d == 0) d = std::numeric_limits<double>::min();
  }
  return distance;
}

/// The best field over all directions, balanced. `share` is that of the work.
CutMaps best_cut_of(const Part& part, const MultiscaleOptions& options, double share) {
  CutMaps cut;
  cut.disk = fill_holes(part.mesh);
  const FilledDisk& disk = cut.disk;
  cut.levels = laplace_levels(disk, options.min_area, options.min_set);
  add_progress(0.4 * share);
  struct Candidate {
    Assessment is;
    std::vector<double> field;
    std::vector<std::vector<Vec2>> lines;
  };
  std::vector<Candidate> candidates(options.directions);
  auto try_direction = [&](int i) {
    Candidate& c = candidates[i];
    c.lines = cut_lines(disk, cut.levels, std::numbers::pi * i / options.directions);
    c.field = cut_line_field(disk, cut.levels, c.lines);
    drop_fragments(part, c.field);
    c.is = assess(part, c.field);
  };
  constexpr std::size_t worth_threads = 4000;  // triangles
  if (part.mesh.tris.size() > worth_threads)
    parallel_for(options.directions, try_direction);
  else
    for (int i = 0; i < options.directions; i++) try_direction(i);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return better(a.is, b.is); });
  if (const Assessment& best = candidates[0].is; !best.valid || best.smaller_share < least_share) {
    candidates.resize(1);
    candidates[0].field = across(part, disk.rim);
    candidates[0].lines.assign(cut.levels.size(), {});
    drop_fragments(part, candidates[0].field);
  }
  // on triangles much longer than wide the sides can lock in a shape that only the mesh explains: then
  // another direction may do better
  constexpr int rounds = 8;
  constexpr double much_longer = 1.5;
  const Branches branches = find_branches(disk, cut.levels);
  for (Candidate& c : candidates) {
    if (!cut.field.empty() && !c.is.valid) break;
    reach_holes(disk, part.opposite, c.field);
    if (cut.field.empty()) cut.field = c.field, cut.lines = c.lines;
    const Assessment before = assess(part, c.field);
    balance_sides(disk, part.opposite, branches, part.crease, c.field, rounds);
    drop_fragments(part, c.field);
    const Assessment after = assess(part, c.field);
    if (before.valid && !(after.valid && after.length < much_longer * before.length)) continue;
    cut.field = std::move(c.field);
    cut.lines = std::move(c.lines);
    break;
  }
  add_progress(0.3 * share);
  return cut;
}

/// A part of a mesh with all that its cut is found with.
Part make_part(Mesh mesh, std::vector<int> opposite, const std::vector<std::uint8_t>& model) {
  Part part;
  part.opposite = std::move(opposite);
  for (std::size_t h = 0; h < 3 * model.size(); h++) {
    if (part.opposite[h] < 0 || !(model[h / 3] >> h % 3 & 1)) continue;
    part.crease.resize(part.opposite.size(), 0);
    part.crease[h] = 1;
  }
  part.mesh = std::move(mesh);
  return part;
}

/// The best cut of a part, and its field there. That of a large part is looked for on a coarse model: the
/// sides that its vertices give to those that have become them are as many and as connected.
CutMaps best_cut(const Part& part, const std::vector<std::uint8_t>& model, const MultiscaleOptions& options,
                 double share, std::vector<double>& field) {
  constexpr int enough = 12000, at_most = 6;  // triangles; of them for one
  constexpr double most_turn = 25 * std::numbers::pi / 180;
  constexpr double worth = 2.5;  // what has thin branches is not made coarse: they need all edges
  const double n = part.mesh.tris.size();
  Coarse coarse;
  if (n > worth * enough)
    coarse = coarsen(part.mesh, part.opposite, model, std::max<int>(enough, n / at_most), most_turn);
  if (coarse.tris.empty() || n < worth * coarse.tris.size()) {
    CutMaps cut = best_cut_of(part, options, share);
    field = cut.field;
    return cut;
  }
  std::vector<int> opposite = opposite_halfedges(coarse.tris, coarse.points.size());
  CutMaps cut = best_cut_of(make_part(coarse, std::move(opposite), coarse.model), options, share);
  field.clear();
  for (int v : coarse.of) field.push_back(cut.field[v]);
  return cut;
}

/// The single-level cut, as it comes; says how much of the part its map cannot tell apart.
CutMaps single_cut(const Part& part, MultiscaleCut& says, std::vector<double>& field) {
  CutMaps cut;
  cut.disk = fill_holes(part.mesh);
  MaxCut one = max_cut(cut.disk);
  says.too_small = one.too_small;
  says.turned_over = one.turned_over;
  cut.levels.push_back(std::move(one.level));
  cut.lines.push_back(std::move(one.line));
  cut.field = field = std::move(one.field);
  return cut;
}

/// A surface with one part cut in two.
struct Halves {
  Surface surface;
  std::vector<int> opposite, side;
  std::vector<Topology> is;
  int loops = 0;  ///< of both together; 0 if they are not parts as the stream wants them
};

/// Measures the two sides of a cut.
void measure_halves(Halves& halves) {
  try {
    halves.is = topology_of_parts(halves.surface, halves.opposite, halves.side, 2);
  } catch (const NotAdmissible&) {  // a pinched vertex, where the line was snapped to one twice
    return;
  }
  for (const Topology& t : halves.is)
    if (t.components != 1 || t.genus != 0 || t.loops < 1) return;
  halves.loops = halves.is[0].loops + halves.is[1].loops;
}

/// Cuts the active triangles, those of the part, along the zero level of its field, pulled straight but for
/// where it follows creases. A line that is snapped to vertices may touch itself there: then it is snapped
/// less, until the halves have no more loops than expected; on a few coarse triangles it may be pulled off
/// the part, so that at last it is left as it is.
Halves split(const Surface& surface, const std::vector<int>& opposite, const Part& part,
             const std::vector<double>& field, const std::vector<char>& active, int expected_loops) {
  struct Pull {
    double snap;
    int sweeps;
  };
  const std::vector<Tri>& tris = part.mesh.tris;
  const LevelLine level = zero_level(part.mesh, field);
  std::vector<Hold> hold(field.size(), Hold::moves);
  for (std::size_t h = 0; h < part.crease.size(); h++) {
    const int u = origin(tris, h), v = target(tris, h), apex = target(tris, next(h));
    if (!part.crease[h] || level.sign[u] != level.sign[v] || level.sign[u] == level.sign[apex]) continue;
    // a triangle may reach far from its crease
    auto reach = [&](int w) {
      return field[w] / (field[w] - field[apex]) * norm(part.mesh.points[apex] - part.mesh.points[w]);
    };
    if (std::max(reach(u), reach(v)) < norm(part.mesh.points[v] - part.mesh.points[u]))
      hold[u] = hold[v] = Hold::joins;
  }
  Halves best;
  for (auto [snap, sweeps] : {Pull{0.1, 60}, Pull{0.03, 30}, Pull{0.01, 30}, Pull{0, 30}, Pull{0, 0}}) {
    LevelLine line = level;
    pull_straight(part.mesh, part.opposite, line, hold, snap, sweeps);
    Halves trial;
    trial.surface = surface;
    trial.opposite = opposite;
    cut_along_line(trial.surface, in_whole(line, part.vertex, surface.points.size()), active, trial.side,
                   &trial.opposite);
    measure_halves(trial);
    if (trial.loops == 0 || (best.loops > 0 && trial.loops >= best.loops)) continue;
    best = std::move(trial);
    if (best.loops <= expected_loops) break;
  }
  return best;
}

/// Joins neighbours one of which was cut here, those with the longest shared border first, while the union is
/// admissible: a ring's two long arcs, each cut lengthwise, make two flat rings. Returns the number of parts.
int join_parts(Surface& surface, std::vector<int>& opposite, int n_parts, const std::vector<char>& was_cut,
               double max_aspect, std::vector<MultiscaleCut>* cuts) {
  std::vector<int>& label = surface.face.get<int>("part");
  if (*std::min_element(label.begin(), label.end()) < 0) return n_parts;  // only some of the parts are given
  Joiner joiner(surface, opposite, label, find_regions(surface, opposite, label, n_parts));
  struct Pair {
    int a, b;
    double length;
  };
  std::vector<int> becomes(n_parts);
  std::iota(becomes.begin(), becomes.end(), 0);
  std::vector<Pair> refused;
  bool joined_any = false;
  for (bool again = true; again;) {
    again = false;
    std::vector<Pair> pairs;
    for (int a = 0; a < n_parts; a++)
      for (int h : joiner.regions().border[a])
        if (int o = opposite[h]; o >= 0 && a < label[o / 3] && (was_cut[a] || was_cut[label[o / 3]]))
          pairs.push_back(
              {a, label[o / 3],
               norm(surface.points[target(surface.tris, h)] - surface.points[origin(surface.tris, h)])});
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& p, const Pair& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
    std::size_t n = 0;
    for (const Pair& p : pairs)
      if (n > 0 && pairs[n - 1].a == p.a && pairs[n - 1].b == p.b)
        pairs[n - 1].length += p.length;
      else
        pairs[n++] = p;
    pairs.resize(n);
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& p, const Pair& q) { return p.length > q.length; });
    for (const Pair& p : pairs) {
      auto same = [&](const Pair& q) { return q.a == p.a && q.b == p.b; };
      if (std::any_of(refused.begin(), refused.end(), same)) continue;
      refused.push_back(p);
      const Region r = joiner.joined(p.a, p.b);
      if (!r.maps_to_the_plane() || r.aspect() > 2 * max_aspect) continue;
      std::vector<int> both(label.size());
      for (std::size_t t = 0; t < both.size(); t++) both[t] = label[t] == p.a || label[t] == p.b ? 0 : -1;
      if (!admissible(topology_of_parts(surface, opposite, both, 1)[0], max_aspect)) continue;
      joiner.join(p.a, p.b);
      for (int& b : becomes)
        if (b == p.b) b = p.a;
      std::erase_if(refused,
                    [&](const Pair& q) { return q.a == p.a || q.b == p.a || q.a == p.b || q.b == p.b; });
      joined_any = again = true;
      break;
    }
  }
  if (!joined_any) return n_parts;
  std::vector<int> number(n_parts, -1);
  int n = 0;
  for (int p = 0; p < n_parts; p++)
    if (becomes[p] == p) number[p] = n++;
  for (int& l : label) l = number[l];
  if (cuts)
    for (MultiscaleCut& c : *cuts)
      for (int& half : c.halves) half = number[becomes[half]];
  constexpr int few = 8;  // each attempt copies the surface
  if (n > few) return n;
  constexpr double snap = 0.1;
  Surface straight = surface;
  std::vector<char> is_union(n, 0);
  for (int p = 0; p < n_parts; p++)
    if (becomes[p] != p) is_union[number[becomes[p]]] = 1;
  std::vector<int> after = opposite;
  straighten_interfaces(straight, after, n, snap, 0, is_union);
  const std::vector<Topology> is = topology_of_parts(straight, after, straight.face.get<int>("part"), n);
  if (std::all_of(is.begin(), is.end(), [&](const Topology& t) { return admissible(t, max_aspect); }))
    surface = std::move(straight), opposite = std::move(after);
  return n;
}

/// The parts' topology, found again for those whose triangles are not as many as they were: a cut splits
/// those of its neighbours.
std::vector<Topology> refreshed(const Surface& surface, const std::vector<int>& opposite,
                                std::vector<Topology> is) {
  std::vector<int> label = surface.face.get<int>("part"), faces(is.size(), 0);
  for (int l : label)
    if (l >= 0) ++faces[l];
  for (int& l : label)
    if (l >= 0 && faces[l] == is[l].faces) l = -1;
  if (*std::max_element(label.begin(), label.end()) < 0) return is;
  std::vector<Topology> changed = topology_of_parts(surface, opposite, label, (int)is.size());
  for (std::size_t p = 0; p < is.size(); p++)
    if (changed[p].faces > 0) is[p] = std::move(changed[p]);
  return is;
}

/// Slivers beside the cuts change hands, unless that makes a part too long. `is` has the parts' topology, as
/// far as it is known.
void drop_slivers(Surface& surface, const std::vector<int>& opposite, double max_aspect,
                  std::vector<Topology>& is) {
  const std::vector<int> before = surface.face.get<int>("part");
  if (!hand_over_slivers(surface, opposite, (int)is.size())) return;
  std::vector<int>& part = surface.face.get<int>("part");
  std::vector<Topology> now = topology_of_parts(surface, opposite, part, (int)is.size());
  if (std::all_of(now.begin(), now.end(), [&](const Topology& t) { return t.eta_geo <= max_aspect; }))
    is = std::move(now);
  else
    part = before;
}

std::string name(int part) { return "part " + std::to_string(part); }

}  // namespace

int multiscale_cut(Surface& surface, const MultiscaleOptions& options, std::vector<MultiscaleCut>* cuts,
                   std::vector<Topology>* topology, std::vector<int>* neighbours) {
  const std::vector<int>& given = surface.face.get<int>("part");
  int n_parts = given.empty() ? 0 : *std::max_element(given.begin(), given.end()) + 1;
  const int given_parts = n_parts;
  std::vector<char> was_cut(n_parts, 0);
  struct Task {
    int part, depth;
    double share;  // of the work, as foreseen
  };
  std::vector<Task> tasks;
  std::vector<int> opposite = opposite_halfedges(surface.tris, surface.points.size());
  std::vector<Topology> is = topology_of_parts(surface, opposite, given, n_parts);
  for (int p = n_parts - 1; p >= 0; p--) {
    if (is[p].components != 1 || is[p].genus != 0 || is[p].loops < 1)
      throw NotAdmissible(name(p) + " has " + std::to_string(is[p].components) + " components, genus " +
                          std::to_string(is[p].genus) + " and " + std::to_string(is[p].loops) +
                          " boundary loops where 1, 0 and at least 1 are needed; run mpartition first");
    if (is[p].eta_geo > options.max_aspect) tasks.push_back({p, 0, (double)is[p].faces});
  }
  // of what a cut is foreseen to take, a third is for cutting its halves again
  constexpr double before = 0.05, all = 0.9, once = 2. / 3;
  add_progress(before);
  double faces = 0;
  for (const Task& t : tasks) faces += t.share;
  for (Task& t : tasks) t.share *= all / faces;
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (task.depth >= max_depth) continue;  // cuts do not make it shorter
    if (options.most_parts > 0 && n_parts >= options.most_parts)
      throw GoalMissed("more than " + std::to_string(options.most_parts) +
                       " parts are needed for aspect ratios below " + std::to_string(options.max_aspect));
    const std::vector<int>& label = surface.face.get<int>("part");
    std::vector<int> mine(label.size());
    std::vector<char> active(label.size());
    for (std::size_t t = 0; t < label.size(); t++) {
      active[t] = label[t] == task.part;
      mine[t] = active[t] ? 0 : -1;
    }
    std::vector<SubMesh> only = split_by_label(surface, mine, 1);
    SubMesh& sub = only[0];
    const std::vector<std::uint8_t> model = model_of(surface, sub);
    std::vector<int> within = std::move(opposite_of_parts(only, opposite, mine)[0]);
    Part part = make_part(std::move(sub), std::move(within), model);
    part.vertex = std::move(sub.vertex);
    MultiscaleCut cut;
    cut.part = task.part;
    cut.halves[0] = task.part;
    cut.halves[1] = n_parts;
    cut.eta = is[task.part].eta_geo;
    std::vector<double> field;
    CutMaps maps = options.method == CutMethod::maxcut
                       ? single_cut(part, cut, field)
                       : best_cut(part, model, options, once * task.share, field);
    cut.levels = maps.levels.size();
    const Assessment expected = assess(part, field);
    cut.length = expected.length / diagonal(part.mesh);
    if (options.keep_maps) cut.maps = std::move(maps);
    const int too_small = cut.too_small, turned_over = cut.turned_over;
    if (cuts) cuts->push_back(std::move(cut));
    auto fail = [&](const std::string& why) {
      std::string message = name(task.part) + " " + why;
      if (options.method == CutMethod::maxcut)
        message += ": one map shrinks " + std::to_string(too_small) + " of " +
                   std::to_string(part.mesh.tris.size()) + " triangles below 1e-15 of area and turns " +
                   std::to_string(turned_over) + " over";
      throw GoalMissed(message);
    };
    Halves made;
    if (!expected.valid || !(made = split(surface, opposite, part, field, active, expected.loops)).loops) {
      if (options.method == CutMethod::maxcut) fail("cannot be cut into 2 connected halves");
      if (cuts) cuts->pop_back();
      continue;
    }
    for (const Topology& half : made.is)
      if (options.method == CutMethod::maxcut && half.eta_geo > options.max_aspect)
        fail("is cut into halves of aspect ratio " + std::to_string(made.is[0].eta_geo) + " and " +
             std::to_string(made.is[1].eta_geo) + ", above " + std::to_string(options.max_aspect));
    constexpr double blind = 0.01;  // a share of the triangles
    if (too_small + turned_over > blind * part.mesh.tris.size())
      fail("is cut by a line that does not see all of it");
    surface = std::move(made.surface);
    opposite = std::move(made.opposite);
    std::vector<int>& labels = surface.face.get<int>("part");
    for (std::size_t t = 0; t < labels.size(); t++)
      if (made.side[t] == 1) labels[t] = n_parts;
    was_cut.resize(n_parts + 1, 0);
    is.resize(n_parts + 1);
    add_progress(0.3 * once * task.share);
    for (int s : {0, 1}) {
      const int half = s ? n_parts : task.part;
      const double share = (1 - once) / 2 * task.share;
      was_cut[half] = 1;
      is[half] = made.is[s];
      if (is[half].eta_geo > options.max_aspect)
        tasks.push_back({half, task.depth + 1, share});
      else
        add_progress(share);
    }
    n_parts++;
  }
  if (n_parts > std::max(given_parts, 2)) {
    const int cut_parts = n_parts;
    n_parts = join_parts(surface, opposite, n_parts, was_cut, options.max_aspect, cuts);
    if (n_parts != cut_parts) is.assign(n_parts, {});
  }
  if (n_parts > 1 && std::find(was_cut.begin(), was_cut.end(), 1) != was_cut.end())
    drop_slivers(surface, opposite, options.max_aspect, is);
  if (topology) *topology = refreshed(surface, opposite, std::move(is));
  if (neighbours) *neighbours = std::move(opposite);
  return n_parts;
}

}  // namespace meshpipe
