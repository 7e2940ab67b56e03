// SPDX-License-Identifier: BSD-3-Clause
// The schedule of the optimisation, its beginning and its end; the steps are in relax_move.cc, relax_edit.cc,
// relax_tips.cc and relax_mend.cc.
#include "lib/relax.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lib/progress.h"
#include "lib/relaxer.h"
#include "lib/size.h"
#include "lib/weld.h"

namespace meshpipe {

RelaxReport relax(LiftedMesh& mesh, const Surface& reference, const std::vector<int>& line_kind,
                  const std::vector<char>& corner, const RelaxOptions& options) {
  const Ground ground(reference);
  Relaxer relaxer(std::move(mesh), ground, line_kind, corner, options);
  const RelaxReport report = relaxer.run();
  mesh = relaxer.take_mesh();
  return report;
}

Ground::Ground(const Surface& reference)
    : surface(reference),
      sizes(reference.vertex.has("size") ? &reference.vertex.get<double>("size") : nullptr),
      walk(reference, reference.face.has("model") ? reference.face.get<std::uint8_t>("model") : no_model),
      normals(reference.points.size()) {
  for (const Tri& t : reference.tris) {
    const Vec3 n = area_vector(reference.points[t[0]], reference.points[t[1]], reference.points[t[2]]);
    for (int v : t) normals[v] = normals[v] + n;
  }
}

Vec3 Ground::normal(const Place& p) const {
  const Tri& v = surface.tris[p.face];
  return normalized(p.b0 * normals[v[0]] + p.b1 * normals[v[1]] + p.b2 * normals[v[2]]);
}

double Ground::size(const Place& p) const {
  const Tri& v = surface.tris[p.face];
  return p.b0 * (*sizes)[v[0]] + p.b1 * (*sizes)[v[1]] + p.b2 * (*sizes)[v[2]];
}

Relaxer::Relaxer(LiftedMesh mesh, const Ground& ground, const std::vector<int>& line_kind,
                 const std::vector<char>& corner, const RelaxOptions& options)
    : ground_(&ground),
      lifted_(std::move(mesh)),
      m_(std::move(lifted_.tris), (int)lifted_.points.size(), lifted_.model),
      options_(options),
      points_(std::move(lifted_.points)),
      facing_(points_.size()),
      held_(points_.size()),
      finer_(points_.size(), 1),
      tried_(points_.size()),
      changed_(points_.size()),
      edited_(points_.size()),
      color_(points_.size(), -1) {
  const int n = (int)points_.size();
  for (int v = 0; v < n; ++v) {
    const int line = lifted_.line[v];
    if (line >= 0 && line_kind[line] != interface_line) held_[v] = slides;
    facing_[v] = facing_at(lifted_.place[v]);
    if (m_.out[v] >= 0) color_[v] = free_color(v);
  }
  std::vector<std::uint8_t> ends(n);
  for (int h = 0; h < (int)m_.hard.size(); ++h)
    if (m_.hard[h] && h > m_.opp[h])
      for (int v : {m_.from(h), m_.to(h)}) {
        held_[v] = slides;
        if (m_.opp[h] >= 0) facing_[v] = {};  // a crease faces two ways
        if (ends[v] < 3) ++ends[v];
      }
  // where an interface ended on a border or model edge, the vertex is free to slide; a corner of the model
  // stays
  for (int v = 0; v < n; ++v) {
    if (!held_[v]) continue;
    const Place& p = lifted_.place[v];
    const Tri& t = ground_->surface.tris[p.face];
    const int at = p.b0 == 1 ? t[0] : p.b1 == 1 ? t[1] : p.b2 == 1 ? t[2] : -1;
    if (ends[v] != 2 || (at >= 0 && !corner.empty() && corner[at])) held_[v] = fixed;
  }
}

/// Where one border runs along another so closely that it is a seam left open, mlines has divided both alike.
/// Chords that differ would cross, so those vertices stay.
void Relaxer::hold_pairs() {
  constexpr double close = 1e-3;  // of the size
  std::vector<char> on_border(points_.size());
  double size = 0;
  std::size_t n = 0;
  for (int v = 0; v < (int)points_.size(); ++v)
    if (m_.out[v] >= 0 && m_.on_border(v)) on_border[v] = 1, size += size_at(v), ++n;
  if (n == 0) return;
  std::vector<int> same(points_.size());
  std::iota(same.begin(), same.end(), 0);
  merge_near(points_, on_border, close * size / (double)n, same);
  for (int v = 0; v < (int)points_.size(); ++v)
    if (same[v] != v) held_[v] = held_[same[v]] = paired;
}

RelaxReport Relaxer::run() {
  hold_pairs();
  const double target = options_.target_triangles > 0 ? options_.target_triangles
                        : ground_->sizes              ? count_for_size(ground_->surface, *ground_->sizes)
                                                      : m_.live;
  merge_corners();
  for (int i = 0; i < 3; ++i) {
    collapse_short_segments();
    split_long(1.4, 1e9);
    collapse_short(0.65, 0);
    flip_to_regular();
    smooth(1);
    add_progress(0.1);
  }
  if (options_.target_triangles > 0)
    meet_count_in_the_end(target);
  else
    optimise(target);
  separate();
  return finish();
}

/// Mending adds triangles where the model is narrow, and a coarse mesh has less area than its reference. What
/// that comes to shows when it is done: then all is done again for sizes that ask for as many less or more,
/// unless that spoils the worst triangle.
void Relaxer::meet_count_in_the_end(double target) {
  constexpr double least = 0.6, spoilt = 0.7;
  // of a first try that is as good as asked for, and of one that was aimed
  constexpr double near_enough = 0.025, near = 0.015;
  // triangles that go with one less asked for; fewer where the model asks for them, not the sizes
  constexpr double sluggish = 0.6, least_response = 0.2;
  constexpr int most_tries = 4, most_sluggish = 3;
  const Relaxer start = *this;
  std::optional<Relaxer> best;
  double goal = target, sound = 0, last_goal = 0, last_live = 0, response = 1;
  auto off = [&](const Relaxer& r) { return std::abs(r.m_.live - target); };
  for (int tries = 1;; ++tries) {
    optimise(goal);
    const double surplus = m_.live - target, shape = quality(worst());
    if (tries == 1) sound = spoilt * shape;
    if (shape >= sound && off(*this) <= (tries == 1 ? near_enough : near) * target) return;
    if (!best || (shape >= sound && off(*this) < off(*best))) best = *this;
    if (tries > 1) response = (m_.live - last_live) / (goal - last_goal);
    if ((shape < sound && surplus > 0) || tries == (response < sluggish ? most_sluggish : most_tries)) break;
    last_goal = goal, last_live = m_.live;
    *this = start;
    goal = std::clamp(goal - surplus / std::max(std::min(response, 1.0), least_response), least * target,
                      target / least);
    if (goal == last_goal) break;
    for (double& f : finer_) f *= std::sqrt(target / goal);
  }
  *this = std::move(*best);
}

/// Sweeps with `target` triangles, then the places that need more than sweeps.
void Relaxer::optimise(double target) {
  for (int i = 0; i < options_.sweeps; ++i) {
    // edits unsettle the mesh, so they come first and the last sweeps only settle it
    if (2 * i < options_.sweeps) {
      meet_count(target);
      remove_irregular();
      remove_dislocations(3);
    }
    flip_to_regular();
    smooth(1);
    flip_to_shape();
    smooth(1);
    add_progress(0.5 / options_.sweeps);
  }
  // what is mended is farther from some tips, what reaches them needs mending
  constexpr int rounds = 5;
  std::vector<Tip> tips = ground_->likely_tips(size_for_count(total_area(ground_->surface), target));
  for (int round = 0; round < rounds; ++round) {
    // on a smooth surface there are none, and the mesh has come to rest in the first round
    if (reach_tips(tips) || round == 0) {
      smooth(1);
      flip_to_shape();
      smooth(1);
    }
    mend_worst();
    add_progress(0.1 / rounds);
  }
}

/// Puts v at a place of the reference.
void Relaxer::put(int v, const Place& place, Vec3 p, Vec3 facing) {
  lifted_.place[v] = place;
  points_[v] = p;
  facing_[v] = facing;
  if (ground_->sizes) lifted_.size[v] = ground_->size(place);
}

/// Splits the longest or collapses the shortest edges until the count is within half a percent of the target.
void Relaxer::meet_count(double target) {
  if (m_.live > 1.005 * target) collapse_short(0.95, target);
  if (m_.live < 0.995 * target) split_long(1.05, target);
}

Mesh Relaxer::compact(std::vector<int>& number) const {
  Mesh now{points_, {}};
  number.clear();
  for (int t = 0; t < (int)m_.tris.size(); ++t)
    if (!m_.dead(t)) now.tris.push_back(m_.tris[t]), number.push_back(t);
  return now;
}

/// Numbers vertices and triangles without gaps, and hands the mesh back.
RelaxReport Relaxer::finish() {
  std::vector<int> number(m_.out.size(), -1), row(m_.tris.size(), -1);
  LiftedMesh& r = lifted_;
  int n = 0;
  for (std::size_t v = 0; v < m_.out.size(); ++v) {
    if (m_.out[v] < 0) continue;
    number[v] = n;
    const bool on_line = held_[v] == slides || held_[v] == fixed || held_[v] == paired;
    r.place[n] = r.place[v], r.size[n] = r.size[v];
    r.kind[n] = on_line ? r.kind[v] : 0, r.line[n] = on_line ? r.line[v] : -1;
    points_[n++] = points_[v];
  }
  points_.resize(n), r.place.resize(n), r.kind.resize(n), r.line.resize(n), r.size.resize(n);
  r.points = std::move(points_);
  r.tris.clear();
  r.model.clear();
  double sum = 0;
  report_.kappa_min = 1;
  for (int t = 0, k = 0; t < (int)m_.tris.size(); ++t) {
    if (m_.dead(t)) continue;
    Tri v;
    std::uint8_t model = 0;
    for (int i = 0; i < 3; ++i) {
      v[i] = number[m_.tris[t][i]];
      if (m_.hard[3 * t + i] && m_.opp[3 * t + i] >= 0) model |= 1 << i;
    }
    r.tris.push_back(v);
    r.model.push_back(model);
    r.patch[k] = r.patch[t], r.part[k] = r.part[t];
    row[t] = k++;
    const double q = kappa(r.points[v[0]], r.points[v[1]], r.points[v[2]]);
    sum += q;
    report_.kappa_min = std::min(report_.kappa_min, q);
  }
  r.patch.resize(r.tris.size()), r.part.resize(r.tris.size());
  report_.kappa_mean = sum / std::max<std::size_t>(1, r.tris.size());
  for (auto& [s, t] : report_.intersections) s = row[s], t = row[t];
  return report_;
}

}  // namespace meshpipe
