// SPDX-License-Identifier: BSD-3-Clause
// The schedule of the optimization.
#include "lib/relax/relax.h"

#include <numeric>

#include "lib/core/error.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/core/spatial_order.h"
#include "lib/core/triangle_count.h"
#include "lib/core/weld.h"
#include "lib/relax/junctions.h"
#include "lib/relax/repair.h"
#include "lib/relax/volumes.h"

namespace meshpipe {
namespace {

/// Holds the vertices of open seams: mlines divides borders this close alike, and chords that differ would
/// cross.
void hold_seams(State& s) {
  const int n = (int)s.points.size();
  std::vector<char> on_border(n);
  double sum = 0;
  std::size_t count = 0;
  for (int v = 0; v < n; ++v)
    if (s.mesh.out[v] >= 0 && s.mesh.on_border(v) && !is_shared(s, v))
      on_border[v] = 1, sum += s.target(v), ++count;
  if (count == 0) return;
  std::vector<int> same(n);
  std::iota(same.begin(), same.end(), 0);
  merge_near(s.points, on_border, rules::open_seam * sum / (double)count, same);
  for (int v = 0; v < n; ++v)
    if (same[v] != v) s.hold[v] = s.hold[same[v]] = paired;
}

/// Removes what is far too short or long, before anything else.
void coarse_rounds(State& s) {
  for (int i = 0; i < rules::coarse_rounds; ++i) {
    merge_corners(s);
    collapse_short_segments(s);
    split_long(s, rules::split_above, 1e9);
    collapse_short(s, rules::collapse_below, 0);
    flip_to_regular(s);
    smooth(s, 1);
    add_progress(0.1);
  }
}

/// Splits the longest or collapses the shortest edges until the count is almost the target.
void meet_count(State& s, double target) {
  if (s.mesh.live > (1 + rules::count_tolerance) * target) collapse_short(s, rules::squeeze_below, target);
  if (s.mesh.live < (1 - rules::count_tolerance) * target) split_long(s, rules::stretch_above, target);
}

/// Sweeps with `target` triangles, then the places that need more than sweeps.
void optimize(State& s, int sweeps, double target, Samples& samples) {
  samples.forget();
  for (int i = 0; i < sweeps; ++i) {
    // edits unsettle the mesh, so they come first and the last sweeps only settle it
    if (2 * i < sweeps) {
      meet_count(s, target);
      remove_irregular(s);
      remove_dislocations(s, rules::dislocation_depth);
    }
    flip_to_regular(s);
    smooth(s, 1);
    flip_to_shape(s);
    smooth(s, 1);
    add_progress(0.5 / sweeps);
  }
  Repairs memory;
  const int most = std::max(rules::features, s.mesh.live / rules::triangles_per_feature);
  for (int round = 0; round < rules::feature_rounds; ++round) {
    // on a smooth surface none is missed, and the mesh has come to rest in the first round
    if (reach_features(s, samples, rules::missed, most) || round == 0) {
      smooth(s, 1);
      flip_to_shape(s);
      smooth(s, 1);
    }
    repair_worst(s, memory);
    add_progress(0.1 / rules::feature_rounds);
  }
}

/// Optimizes so that `target` triangles are left in the end. Repair adds some where the model is narrow, and
/// a coarse mesh has less area than its reference: the count is known only after optimization, so repeat with
/// a rescaled size field until it is within 1.5 %, unless the worst triangle gets worse.
int optimize_to_count(State& s, int sweeps, double target, Samples& samples) {
  const State start = s;
  std::optional<State> best;
  double goal = target, sound = 0, last_goal = 0, last_live = 0, response = 1;
  auto off = [&](const State& state) { return std::abs(state.mesh.live - target); };
  int tries = 1;
  for (;; ++tries) {
    optimize(s, sweeps, goal, samples);
    const double surplus = s.mesh.live - target, shape = quality(s, worst(s));
    if (tries == 1) sound = rules::spoilt * shape;
    if (shape >= sound && off(s) <= (tries == 1 ? rules::count_first : rules::count_aimed) * target)
      return tries;
    if (!best || (shape >= sound && off(s) < off(*best))) best = s;
    if (tries > 1) response = (s.mesh.live - last_live) / (goal - last_goal);
    if (shape < sound && surplus > 0) break;
    if (tries >= (response < rules::sluggish ? rules::sluggish_tries : rules::tries)) break;
    last_goal = goal, last_live = s.mesh.live;
    s = start;
    goal = std::clamp(goal - surplus / std::max(std::min(response, 1.0), rules::least_response),
                      rules::goal_range * target, target / rules::goal_range);
    if (goal == last_goal) break;
    for (double& f : s.refinement) f *= std::sqrt(target / goal);
  }
  s = std::move(*best);
  samples.forget();
  return tries;
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
  return s;
}

/// The same of the mesh; its places stay.
void rearrange_lifted(LiftedMesh& mesh) {
  const SpatialOrder order = spatial_order(mesh);
  rearrange(mesh, order);
  mesh.place = rearranged(mesh.place, order.vertices);
  for (std::vector<int>* column : {&mesh.kind, &mesh.line}) *column = rearranged(*column, order.vertices);
  mesh.size = rearranged(mesh.size, order.vertices);
  for (std::vector<int>* column : {&mesh.patch, &mesh.part}) *column = rearranged(*column, order.tris);
  mesh.model = rearranged(mesh.model, order.tris);
}

}  // namespace

RelaxReport relax(LiftedMesh& mesh, const Surface& original, const std::vector<int>& line_kind,
                  const std::vector<char>& corners, const RelaxOptions& options) {
  if (mesh.tris.empty()) throw NotAdmissible("the mesh has no triangles");
  // both in an order by place: else most of the time would be spent waiting for memory
  SpatialOrder order;
  Surface surface;
  std::optional<Reference> reference;
  parallel_for(
      2,
      [&](int side) {
        if (side == 1) return rearrange_lifted(mesh);
        order = spatial_order(original);
        surface = rearranged_surface(original, order);
        reference.emplace(surface);
      },
      original.tris.size() > rules::half_edges_worth_threads / 3);
  const std::vector<int> row = new_rows(order.tris);
  for (Place& p : mesh.place) p.face = row[p.face];
  const std::vector<char> corner = corners.empty() ? corners : rearranged(corners, order.vertices);
  State s = start_state(mesh, *reference, line_kind, corner, options.sheets_meet);
  s.keep_border = options.keep_border;
  part_double_edges(s);
  hold_seams(s);
  const double natural = reference->sizes ? count_for_size(surface, *reference->sizes) : s.mesh.live;
  coarse_rounds(s);
  const double target = options.target_triangles > 0 ? options.target_triangles : natural;
  Samples samples{feature_samples(*reference, size_for_count(total_area(surface), target)), {}};
  int tries = 1;
  if (options.target_triangles > 0)
    tries = optimize_to_count(s, options.sweeps, target, samples);
  else
    optimize(s, options.sweeps, natural, samples);
  const Intersections left = remove_faults(s, samples);
  RelaxReport report{s.counts, left.pairs, left.of_reference};
  report.tries = tries;
  const std::vector<int> left_at = finish(s, mesh);
  if (!options.sheets.empty()) report.volume_error = keep_volumes(mesh, original, options.sheets);
  for (auto& [a, b] : report.intersections) a = left_at[a], b = left_at[b];
  report.kappa_min = 1;
  for (const auto& [a, b, c] : mesh.tris) {
    const double q = kappa(mesh.points[a], mesh.points[b], mesh.points[c]);
    report.kappa_mean += q;
    report.kappa_min = std::min(report.kappa_min, q);
  }
  report.kappa_mean /= (double)std::max<std::size_t>(1, mesh.tris.size());
  for (Place& p : mesh.place) p.face = order.tris[p.face];
  return report;
}

}  // namespace meshpipe
