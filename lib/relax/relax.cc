// SPDX-License-Identifier: BSD-3-Clause
// The schedule of the optimization.
#include "lib/relax/relax.h"

#include "lib/core/bvh.h"
#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/original_triangles.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/spatial_order.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"
#include "lib/core/weld.h"
#include "lib/relax/junctions.h"
#include "lib/relax/repair.h"
#include "lib/relax/tiles.h"
#include "lib/relax/volumes.h"

namespace meshpipe {
namespace {

/// Holds the vertices of open seams: mlines divides borders this close alike; chords that differ cross.
template <class Size>
void hold_seams(const std::vector<Vec3>& points, const std::vector<char>& on_border, Size size,
                std::vector<Hold>& hold) {
  const int n = (int)points.size();
  double sum = 0;
  std::size_t count = 0;
  for (int v = 0; v < n; ++v)
    if (on_border[v]) sum += size(v), ++count;
  if (count == 0) return;
  std::vector<int> same = identity(n);
  merge_near(points, on_border, rules::open_seam * sum / (double)count, same);
  for (int v = 0; v < n; ++v)
    if (same[v] != v) hold[v] = hold[same[v]] = paired;
}

/// Removes what is far too short or long, before anything else.
void coarse_rounds(State& s) {
  split_chords(s);
  for (int i = 0; i < rules::coarse_rounds; ++i) {
    open_peaks(s);
    merge_corners(s);
    collapse_short_segments(s);
    split_long(s, rules::split_above, 1e9);
    collapse_short(s, rules::collapse_below, 0);
    flip_to_regular(s);
    smooth(s, 1);
    add_progress(0.1 * s.whole.share);
  }
}

/// Splits the longest or collapses the shortest edges until the count is almost the target.
void meet_count(State& s, double target) {
  if (s.mesh.live > (1 + rules::count_tolerance) * target) collapse_short(s, rules::squeeze_below, target);
  if (s.mesh.live < (1 - rules::count_tolerance) * target) split_long(s, rules::stretch_above, target);
}

/// Smooths twice, with flips between.
void even_out(State& s) {
  smooth(s, 1);
  flip_to_shape(s);
  smooth(s, 1);
}

/// Sweeps with `target` triangles.
void sweep(State& s, int sweeps, double target) {
  for (int i = 0; i < sweeps; ++i) {
    // edits unsettle the mesh, so they come first and the last sweeps only settle it
    if (2 * i < sweeps) {
      meet_count(s, target);
      remove_irregular(s);
      remove_dislocations(s, rules::dislocation_depth);
    }
    flip_to_regular(s);
    even_out(s);
    add_progress(0.5 / sweeps * s.whole.share);
  }
}

/// Reaches features and repairs, where places need more than sweeps. On a smooth surface no feature is
/// missed, and a mesh that is not `at_rest` comes to it in the first round.
void attend_to_places(State& s, Samples& samples, bool at_rest) {
  Repairs memory;
  const int most = std::max(rules::features, s.mesh.live / rules::triangles_per_feature);
  const int most_live = s.whole.keep_count ? (int)(rules::repair_growth * s.mesh.live) : INT_MAX;
  for (int round = 0; round < rules::feature_rounds; ++round) {
    if (reach_features(s, samples, rules::missed, most) || (round == 0 && !at_rest)) even_out(s);
    repair_worst(s, memory, -1, most_live);
    add_progress(0.1 / rules::feature_rounds * s.whole.share);
  }
}

/// Attends to places after sweeps. Without samples, as tiles have none until their seams have been swept,
/// too, it only comes to rest.
void finish_sweeps(State& s, Samples* samples) {
  if (!samples) return even_out(s);
  samples->forget();
  attend_to_places(s, *samples, false);
}

/// Sweeps with `target` triangles, then attends to places.
void optimize(State& s, int sweeps, double target, Samples* samples) {
  sweep(s, sweeps, target);
  finish_sweeps(s, samples);
}

/// Sweeps again from `start`, with sizes for `goal` triangles instead of `target`, until about `wanted` are
/// left; `goal` made `live` of them before. Returns the last goal.
double sweep_to_count(State& s, const State& start, int sweeps, double target, double wanted, double goal,
                      double live) {
  double response = 1;
  for (int i = 0; i < rules::sweeps_to_count; ++i) {
    const double last_goal = goal, last_live = live;
    goal = std::clamp(goal - (live - wanted) / std::clamp(response, rules::least_response, 1.0),
                      rules::goal_range * target, target / rules::goal_range);
    if (goal == last_goal) break;
    s = start;
    for (double& f : s.refinement) f *= std::sqrt(target / goal);
    sweep(s, sweeps, goal);
    live = s.mesh.live;
    if (std::abs(live - wanted) <= rules::count_tolerance * target) break;
    response = (live - last_live) / (goal - last_goal);
  }
  return goal;
}

/// Optimizes so that `target` triangles are left in the end. Repair adds some where the model is narrow, and
/// a coarse mesh has less area than its reference: the count is known only after optimization, so repeat with
/// a rescaled size field until it is within 1.5 %, unless the worst triangle gets worse. Returns the number
/// of optimizations, and the goal of the one that is kept, whose sizes are sqrt(target / goal) times the
/// wanted.
std::pair<int, double> optimize_to_count(State& s, int sweeps, double target, Samples* samples) {
  const State start = s;
  std::optional<State> best;
  double goal = target, kept = target, sound = 0, response = 1;
  int last_swept = 0, last_live = 0;
  auto off = [&](const State& state) { return std::abs(state.mesh.live - target); };
  sweep(s, sweeps, goal);
  for (int tries = 1;; ++tries) {
    const int swept = s.mesh.live;
    finish_sweeps(s, samples);
    const double shape = quality(s, worst(s));
    if (tries == 1) sound = rules::spoilt * shape;
    const double within = tries == 1 ? rules::count_first : rules::count_aimed;
    if (shape >= sound && off(s) <= within * target) return {tries, goal};
    if (tries > 1 && swept != last_swept) response = double(s.mesh.live - last_live) / (swept - last_swept);
    last_swept = swept, last_live = s.mesh.live;
    const double surplus = s.mesh.live - target;
    const double wanted = swept - surplus / std::clamp(response, rules::least_response, 1.0);
    const bool spoilt = shape < sound && surplus > 0;
    if (!best || (shape >= sound && off(s) < off(*best))) best = s, kept = goal;
    const double last = goal;
    if (!spoilt && tries < rules::tries) goal = sweep_to_count(s, start, sweeps, target, wanted, goal, swept);
    if (goal == last) {
      s = std::move(*best);
      if (samples) samples->forget();
      return {tries, kept};
    }
  }
}

/// Reduces the size of each vertex that is nearer to a place of reduction than its own size, and of those
/// around by gradation. Returns whether there were such vertices.
bool reduce_sizes(State& s, const std::vector<SizeReduction>& reductions) {
  const int n = (int)s.points.size();
  std::vector<double> size(n);
  std::vector<int> reduced;
  for (int v = 0; v < n; ++v) {
    const double before = size[v] = s.target(v);
    for (const SizeReduction& r : reductions)
      if (norm(s.points[v] - r.at) < before) size[v] = std::min(size[v], r.factor * before);
    if (s.mesh.out[v] >= 0 && size[v] < before) reduced.push_back(v);
  }
  shortest_paths(reduced, size, [&](int v, auto reach) {
    for_copies(s, v, [&](int c) { reach(c, size[v]); });
    s.mesh.neighbors(
        v, [&](int u) { reach(u, size[v] + rules::reduced_gradation * norm(s.points[u] - s.points[v])); });
  });
  for (int v = 0; v < n; ++v) s.refinement[v] *= size[v] / s.target(v);
  return !reduced.empty();
}

/// The number of triangles that the sizes ask for beyond what they do with factors `before` on them.
double triangles_added(const State& s, const std::vector<double>& before) {
  double added = 0;
  for (const auto& [a, b, c] : s.mesh.tris) {
    const double ratio = (s.size[a] * before[a] + s.size[b] * before[b] + s.size[c] * before[c]) /
                         (s.target(a) + s.target(b) + s.target(c));
    added += ratio * ratio - 1;
  }
  return added;
}

/// Removes faults. Where some are left for which mcheck would refuse the mesh, sizes are too large: the mesh
/// at the `start` is optimized to `goal` again, with smaller ones there, as long as that halves them. Returns
/// what is left, and sets the number of restarts.
Intersections remove_all_faults(State& s, State start, int sweeps, double goal, Samples& samples,
                                int& restarts) {
  const std::vector<double> refinement = start.refinement;
  Faults left = remove_faults(s, samples);
  while (restarts < rules::most_restarts && !left.reductions.empty()) {
    if (!reduce_sizes(start, left.reductions)) break;
    const double added = triangles_added(start, refinement);
    if (added > rules::reduced_growth * goal) break;
    State again = start;
    coarse_rounds(again);
    optimize(again, sweeps, goal + added, &samples);
    Faults now = remove_faults(again, samples);
    ++restarts;
    const bool halved = now.lowest < rules::halved * left.lowest;
    if (now.less_than(left))
      s = std::move(again), left = std::move(now);
    else
      left.reductions = now.reductions, left.lowest = now.lowest;
    if (!halved) break;
  }
  return left;
}

/// The surface with its columns in another order.
Surface rearranged_surface(const Surface& surface, const SpatialOrder& order) {
  Surface s;
  static_cast<Mesh&>(s) = surface;
  rearrange(s, order);
  if (surface.vertex.has("size"))
    s.vertex.set("size", rearranged(surface.vertex.get<double>("size"), order.vertices));
  if (surface.face.has("model"))
    s.face.set("model", rearranged(surface.face.get<std::uint8_t>("model"), order.tris));
  for (const char* column : {"patch", "origin"})
    if (surface.face.has(column)) s.face.set(column, rearranged(surface.face.get<int>(column), order.tris));
  return s;
}

/// The same of the mesh; its places stay. Returns the order.
SpatialOrder rearrange_lifted(LiftedMesh& mesh) {
  SpatialOrder order = spatial_order(mesh);
  rearrange(mesh, order);
  mesh.place = rearranged(mesh.place, order.vertices);
  for (std::vector<int>* column : {&mesh.kind, &mesh.line}) *column = rearranged(*column, order.vertices);
  mesh.size = rearranged(mesh.size, order.vertices);
  for (std::vector<int>* column : {&mesh.patch, &mesh.part}) *column = rearranged(*column, order.tris);
  mesh.model = rearranged(mesh.model, order.tris);
  return order;
}

/// The component of each triangle of the reference; none unless each has a part of the mesh for itself, as it
/// has in the chain.
std::vector<int> components_below(const LiftedMesh& mesh, const Reference& reference) {
  std::vector<int> component;
  std::vector<char> has(components(reference.walk.opposite(), component));
  for (const auto& [a, b, c] : mesh.tris) {
    auto of = [&](int v) { return component[mesh.place[v].face]; };
    if (of(a) != of(b) || of(a) != of(c)) return {};
    has[of(a)] = 1;
  }
  if (std::count(has.begin(), has.end(), 0)) return {};
  return component;
}

/// A mesh and its reference in an order by place: else most of the time would be spent waiting for memory.
struct Ordered {
  SpatialOrder mesh, reference;
  Surface surface;
  std::optional<Reference> on;

  Ordered(LiftedMesh& lifted, const Surface& original) {
    auto rearrange_side = [&](int side) {
      if (side == 1)
        mesh = rearrange_lifted(lifted);
      else
        reference = spatial_order(original), surface = rearranged_surface(original, reference);
    };
    parallel_for(2, rearrange_side, original.tris.size() > rules::half_edges_worth_threads / 3);
    on.emplace(surface);  // on all threads
    const std::vector<int> row = new_rows(reference.tris);
    for (Place& p : lifted.place) p.face = row[p.face];
  }
  std::vector<char> of_points(const std::vector<char>& column) const {
    return column.empty() ? column : rearranged(column, reference.vertices);
  }
};

void set_quality(RelaxReport& report, const Mesh& mesh) {
  report.kappa_min = 1;
  for (const auto& [a, b, c] : mesh.tris) {
    const double q = kappa(mesh.points[a], mesh.points[b], mesh.points[c]);
    report.kappa_mean += q;
    report.kappa_min = std::min(report.kappa_min, q);
  }
  report.kappa_mean /= (double)std::max<std::size_t>(1, mesh.tris.size());
}

RelaxReport relax_whole(LiftedMesh& mesh, const Surface& original, const std::vector<int>& line_kind,
                        const std::vector<char>& corners, const RelaxOptions& options) {
  Ordered ordered(mesh, original);
  if (!options.sheets_meet) ordered.on->component = components_below(mesh, *ordered.on);
  const std::vector<char> corner = ordered.of_points(corners);
  State s = start_state(mesh, *ordered.on, line_kind, corner, options.sheets_meet);
  s.keep_border = options.keep_border, s.whole.keep_count = options.keep_count;
  expect_single_fans(s);
  part_double_edges(s);
  std::vector<char> on_border(s.points.size());
  for (int v = 0; v < (int)on_border.size(); ++v)
    on_border[v] = s.mesh.out[v] >= 0 && s.mesh.on_border(v) && !is_shared(s, v);
  hold_seams(
      s.points, on_border, [&](int v) { return s.target(v); }, s.hold);
  const Surface& surface = ordered.surface;
  const double natural = ordered.on->sizes ? count_for_size(surface, *ordered.on->sizes) : s.mesh.live;
  State start = s;
  coarse_rounds(s);
  const double target = options.target_triangles > 0 ? options.target_triangles : natural;
  Samples samples{feature_samples(*ordered.on, size_for_count(total_area(surface), target)), {}};
  int tries = 1, restarts = 0;
  double goal = natural;
  if (options.target_triangles > 0) {
    std::tie(tries, goal) = optimize_to_count(s, options.sweeps, target, &samples);
    for (double& f : start.refinement) f *= std::sqrt(target / goal);
  } else {
    optimize(s, options.sweeps, natural, &samples);
  }
  const Intersections left = remove_all_faults(s, std::move(start), options.sweeps, goal, samples, restarts);
  RelaxReport report{s.counts, left.pairs, left.of_reference};
  report.tries = tries, report.restarts = restarts;
  const std::vector<int> left_at = finish(s, mesh);
  if (!options.sheets.empty()) report.volume_error = keep_volumes(mesh, original, options.sheets);
  for (auto& [a, b] : report.intersections) a = left_at[a], b = left_at[b];
  for (Place& p : mesh.place) p.face = ordered.reference.tris[p.face];
  return report;
}

/// Drops the samples that are nearer to other triangles of the whole than to the tile.
void keep_own(const State& s, const Mesh& others, double size, Samples& samples) {
  const double enough = rules::missed * size;
  const std::vector<double> distance = sample_distances(s, samples, enough);
  if (others.tris.empty()) return;
  std::optional<Bvh> tree;
  std::size_t n = 0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const Sample& x = samples.list[i];
    if (!(distance[i] <= enough)) {
      if (!tree) tree.emplace(others);
      const Vec3 p = s.reference->walk.point(x.place);
      if (tree->nearest_within(p, distance[i], distance[i]).place.face >= 0) continue;
    }
    samples.list[n++] = x;
  }
  samples.list.resize(n);
}

/// Moves what has become of a tile back to it.
void finish_tile(State& s, const Ordered& ordered, Tile& tile) {
  std::vector<int> number(ordered.mesh.vertices.size());  // of what is frozen, by that in the tile as it was
  tile.hold.clear(), tile.refinement.clear();
  for (int v = 0; v < (int)s.mesh.out.size(); ++v) {
    if (s.mesh.out[v] < 0) continue;
    if (s.hold[v] == frozen) number[ordered.mesh.vertices[v]] = (int)tile.hold.size();
    tile.hold.push_back(s.hold[v] == slides ? loose : s.hold[v]);
    tile.refinement.push_back(s.refinement[v]);
  }
  for (int& v : tile.rim.vertex) v = number[v];
  finish(s, tile.mesh);
  // the first weight as a stream has it, which holds two: so shards are the same to the bit
  for (Place& p : tile.mesh.place)
    p = {tile.faces[ordered.reference.tris[p.face]], 1 - p.b1 - p.b2, p.b1, p.b2};
  tile.others = {};  // frees memory now: other tiles are still at work
  tile.faces = {}, tile.rim.excess = {}, tile.corner = {};
}

/// The tiles of a region of a mesh, to be cut one by one.
struct Tiles {
  Tiles(const TiledMesh& mesh, const std::vector<int>& region, int most, const TiledRelax& relax, bool repair)
      : whole(mesh),
        by(relax),
        boxes(split_into_boxes(mesh.mesh, region, most)),
        at_vertex(triangles_at_vertices(mesh.mesh)),
        faces(around_tiles(mesh.mesh, boxes, rules::around_tile, &relax.reference)) {
    if (repair) others = around_tiles(mesh.mesh, boxes, rules::around_tile, nullptr);
  }
  int size() const { return (int)boxes.size(); }
  Tile cut(int i) const {
    return cut_tile(whole, at_vertex, by.reference, by.corner, boxes, faces, others, i);
  }

  const TiledMesh& whole;
  const TiledRelax& by;
  std::vector<std::vector<int>> boxes;
  Lists at_vertex, faces, others;
};

/// Makes a pass over the tiles of a region, from the second `round` on over their seams only, without another
/// look at the number of triangles.
void relax_region(const TiledRelax& by, TiledMesh& whole, std::vector<int> region, TilePass pass, int round,
                  RelaxCounts& counts) {
  for (; round < rules::seam_rounds && !region.empty(); ++round) {
    if (round > 0) pass.goal = 1, pass.to_count = false;
    const int most = round + 1 < rules::seam_rounds ? by.options.tile : (int)region.size();
    std::vector<Tile> relaxed;
    {
      const Tiles tiles(whole, region, most, by, pass.repair);
      relaxed.resize(tiles.size());
      parallel_for(tiles.size(), [&](int i) {
        relaxed[i] = tiles.cut(i);
        relax_tile(relaxed[i], by.line_kind, pass);
      });
    }
    std::vector<int> number = remove_region(whole, region), seams;
    std::size_t points = whole.hold.size(), triangles = whole.mesh.tris.size();
    for (const Tile& tile : relaxed) points += tile.hold.size(), triangles += tile.mesh.tris.size();
    reserve(whole, points, triangles);
    for (Tile& tile : relaxed) {
      add(counts, tile.counts);
      append_tile(whole, tile, number, seams);
      tile = {};  // frees its memory now
    }
    region = triangles_near(whole.mesh, seams, rules::seam_rings);
  }
}

/// Repairs where tiles intersect that do not know each other. Returns what still intersects.
Intersections part_tiles(const TiledRelax& by, TiledMesh& whole, RelaxCounts& counts) {
  std::optional<Mesh> known;
  for (int round = 0;; ++round) {
    const auto boxes = split_into_boxes(whole.mesh, identity(whole.mesh.tris.size()), by.options.tile);
    Intersections found{tile_intersections(whole.mesh, boxes, rules::around_seams)};
    if (found.pairs.empty()) return found;
    if (!known) known = reference_contacts(by.reference, false);
    const int all = (int)found.pairs.size();
    found.pairs = new_intersections(whole.mesh, found.pairs, *known);
    found.of_reference = all - (int)found.pairs.size();
    if (found.pairs.empty() || round == rules::intersection_rounds) return found;
    std::vector<int> corners;
    for (const auto& [s, t] : found.pairs)
      for (int u : {s, t})
        corners.insert(corners.end(), whole.mesh.tris[u].begin(), whole.mesh.tris[u].end());
    sort_unique(corners);
    relax_region(by, whole, triangles_near(whole.mesh, corners, rules::intersection_rings),
                 by.pass(whole, true), 0, counts);
  }
}

}  // namespace

void add(RelaxCounts& sum, const RelaxCounts& r) {
  sum.splits += r.splits, sum.collapses += r.collapses, sum.flips += r.flips, sum.moves += r.moves;
  sum.corners_merged += r.corners_merged;
  sum.tries = std::max(sum.tries, r.tries);
}

void relax_tile(Tile& tile, const std::vector<int>& line_kind, const TilePass& pass) {
  const double goal = pass.goal * (double)tile.mesh.tris.size();
  const Ordered ordered(tile.mesh, tile.slice);
  tile.slice = {};
  State s = start_state(tile.mesh, *ordered.on, line_kind, ordered.of_points(tile.corner));
  s.keep_border = pass.keep_border, s.whole.keep_count = pass.keep_count;
  s.whole.mean_size = pass.mean_size;
  s.whole.share = pass.share;
  s.whole.rim_excess.resize(s.points.size());
  std::vector<int> excess(s.points.size());
  for (std::size_t i = 0; i < tile.rim.vertex.size(); ++i) excess[tile.rim.vertex[i]] = tile.rim.excess[i];
  for (int v = 0; v < (int)s.points.size(); ++v) {
    const int row = ordered.mesh.vertices[v];
    s.whole.rim_excess[v] = excess[row] - s.mesh.valence(v);
    if (tile.hold[row] != loose) s.hold[v] = tile.hold[row];
    if (tile.hold[row] == frozen && s.labels.line[v] >= 0) s.normal[v] = {};  // perhaps a model edge
    s.refinement[v] = tile.refinement[row];
  }
  expect_single_fans(s);
  int tries = 1;
  if (pass.repair) {
    Samples samples{feature_samples(*ordered.on, pass.sample_size), {}};
    keep_own(s, tile.others, pass.sample_size, samples);
    rest(s);
    attend_to_places(s, samples, true);
    remove_faults(s, samples);
  } else {
    coarse_rounds(s);
    if (pass.to_count)
      tries = optimize_to_count(s, pass.sweeps, goal, nullptr).first;
    else
      optimize(s, pass.sweeps, goal, nullptr);
  }
  finish_tile(s, ordered, tile);
  tile.counts = s.counts;
  tile.counts.tries = tries;
}

bool uses_tiles(const LiftedMesh& mesh, const RelaxOptions& options) {
  return (double)mesh.tris.size() > 4.0 * options.tile && !options.sheets_meet && options.sheets.empty();
}

TiledMesh as_tiled(LiftedMesh mesh) {
  const std::size_t n = mesh.points.size();
  TiledMesh whole{std::move(mesh), std::vector<Hold>(n), std::vector<double>(n, 1)};
  for (Place& p : whole.mesh.place) p.b0 = 1 - p.b1 - p.b2;  // as in finish_tile
  const std::vector<int> opposite = opposite_halfedges(whole.mesh.tris, (int)n);
  std::vector<char> on_border(n);
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] < 0) on_border[origin(whole.mesh.tris, h)] = 1;
  hold_seams(
      whole.mesh.points, on_border, [&](int v) { return whole.mesh.size[v]; }, whole.hold);
  return whole;
}

TilePass TiledRelax::pass(const TiledMesh& whole, bool repair) const {
  const double live = (double)whole.mesh.tris.size();
  const double natural =
      reference.vertex.has("size") ? count_for_size(reference, reference.vertex.get<double>("size")) : live;
  const double target = options.target_triangles > 0 ? options.target_triangles : natural;
  TilePass pass{options.sweeps, options.keep_border, repair};
  pass.to_count = options.target_triangles > 0, pass.keep_count = options.keep_count;
  pass.goal = target / live;
  pass.sample_size = size_for_count(total_area(reference), target);
  pass.mean_size = size_for_count(total_area(whole.mesh), live);
  pass.share = 0.8 * options.tile / live;
  return pass;
}

void TiledRelax::cut(const TiledMesh& whole, const TilePass& pass,
                     const std::function<void(Tile)>& take) const {
  const Tiles tiles(whole, identity(whole.mesh.tris.size()), options.tile, *this, pass.repair);
  for (int i = 0; i < tiles.size(); ++i) take(tiles.cut(i));
}

void TiledRelax::relax_seams(TiledMesh& whole, const std::vector<int>& seams, const TilePass& pass,
                             RelaxCounts& counts) const {
  relax_region(*this, whole, triangles_near(whole.mesh, seams, rules::seam_rings), pass, 1, counts);
}

RelaxReport TiledRelax::finish(TiledMesh& whole, int passes, const RelaxCounts& counts) const {
  RelaxReport report;
  static_cast<RelaxCounts&>(report) = counts;
  for (int i = passes; i < 2; ++i)
    relax_region(*this, whole, identity(whole.mesh.tris.size()), pass(whole, i == 1), 0, report);
  const Intersections left = part_tiles(*this, whole, report);
  report.intersections = left.pairs, report.intersections_of_reference = left.of_reference;
  set_quality(report, whole.mesh);
  return report;
}

RelaxReport relax(LiftedMesh& mesh, const Surface& original, const std::vector<int>& line_kind,
                  const std::vector<char>& corners, const RelaxOptions& options) {
  if (mesh.tris.empty()) throw NotAdmissible("the mesh has no triangles");
  if (!uses_tiles(mesh, options)) {
    RelaxReport report = relax_whole(mesh, original, line_kind, corners, options);
    set_quality(report, mesh);
    return report;
  }
  TiledMesh whole = as_tiled(std::move(mesh));
  RelaxReport report = TiledRelax{original, line_kind, corners, options}.finish(whole, 0, {});
  mesh = std::move(whole.mesh);
  return report;
}

}  // namespace meshpipe
