// SPDX-License-Identifier: BSD-3-Clause
// The few places that need more than sweeps: the worst triangles and intersections.
#include <algorithm>
#include <cmath>
#include <optional>

#include "lib/bvh.h"
#include "lib/intersect.h"
#include "lib/parallel.h"
#include "lib/relaxer.h"

namespace meshpipe {

// --- the worst triangles ---

/// 1 for a triangle that is good enough: kappa 0.75 and 35 degrees; 0 for one that is folded over.
double Relaxer::quality(int t) const {
  constexpr double good_kappa = 0.75, good_angle = 35 * 3.14159265358979323846 / 180;
  const auto [a, b, c] = m_.tris[t];
  if (agrees(a, b, c) < 0) return 0;
  const Vec3 p = at(a), q = at(b), r = at(c);
  const double k = kappa(p, q, r), pq = dot(q - p, q - p), qr = dot(r - q, r - q), rp = dot(p - r, p - r);
  // the least angle is opposite to the shortest side
  const Vec3 u = qr <= pq && qr <= rp ? q - p
                 : rp <= pq           ? r - q
                                      : p - r,
             v = qr <= pq && qr <= rp ? r - p
                 : rp <= pq           ? p - q
                                      : q - r;
  // where it is good with a margin there is no need to know it
  constexpr double tangent = 0.747;  // of 1.05 times the good angle
  if (norm(cross(u, v)) > tangent * dot(u, v)) return k / good_kappa;
  return std::min(k / good_kappa, angle(u, v) / good_angle);
}

/// What is to be made small: counts the worst triangles most, and none that is good with a margin; and inside
/// vertices whose valence is not 5, 6 or 7.
double Relaxer::badness() const {
  constexpr double irregular = 1e-3;
  double sum = 0;
  for (int v = 0; v < (int)m_.out.size(); ++v) sum += irregular * irregularity(v);
  for (int t = 0; t < (int)m_.tris.size(); ++t) {
    if (m_.dead(t)) continue;
    const double q = quality(t), lack = std::max(0.0, 1.05 - q);
    sum += lack * lack * lack / (q + 0.05);  // one needle is worse than two slivers
  }
  return sum;
}

/// Triangle t, then those that are up to `rings` vertices away.
std::vector<int> Relaxer::triangles_round(int t, int rings) const {
  std::vector<int> found{t}, sorted{t};
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<int> more;
    for (int s : found)
      for (int v : m_.tris[s])
        m_.star(v, [&](int h) {
          if (!std::binary_search(sorted.begin(), sorted.end(), h / 3)) more.push_back(h / 3);
        });
    std::sort(more.begin(), more.end());
    more.erase(std::unique(more.begin(), more.end()), more.end());
    found.insert(found.end(), more.begin(), more.end());
    sorted = found;
    std::sort(sorted.begin(), sorted.end());
  }
  return found;
}

/// Their vertices, ascending.
std::vector<int> Relaxer::vertices_of(const std::vector<int>& triangles) const {
  std::vector<int> vertices;
  for (int t : triangles) vertices.insert(vertices.end(), m_.tris[t].begin(), m_.tris[t].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

/// These triangles as a mesh of their own whose rim stays as it is. `vertices`: vertices_of them.
Relaxer Relaxer::patch(const std::vector<int>& triangles, const std::vector<int>& vertices) const {
  LiftedMesh part;
  auto local = [&](int v) {
    return (int)(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  };
  for (int v : vertices) {
    part.points.push_back(at(v));
    part.place.push_back(lifted_.place[v]);
    part.size.push_back(lifted_.size[v]);
  }
  part.kind.assign(vertices.size(), 0);
  part.line.assign(vertices.size(), -1);
  for (int t : triangles) {
    const Tri& v = m_.tris[t];
    part.tris.push_back({local(v[0]), local(v[1]), local(v[2])});
    part.model.push_back(m_.hard[3 * t] | m_.hard[3 * t + 1] << 1 | m_.hard[3 * t + 2] << 2);
  }
  part.patch.assign(triangles.size(), 0);
  part.part.assign(triangles.size(), 0);
  Relaxer r(std::move(part), *ground_, {}, {}, options_);
  for (int i = 0; i < (int)vertices.size(); ++i) {
    const int v = vertices[i];
    r.held_[i] = held_[v];
    r.facing_[i] = facing_[v];
    r.finer_[i] = finer_[v];
  }
  for (int i = 0; i < (int)triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (r.m_.opp[3 * i + k] < 0 && m_.opp[3 * triangles[i] + k] >= 0)
        r.held_[r.m_.from(3 * i + k)] = r.held_[r.m_.to(3 * i + k)] = frozen;
  r.recording_ = true;
  return r;
}

/// Makes a change if it may be made.
bool Relaxer::try_edit(const Edit& edit) {
  const std::size_t before = edits_.size();
  if (edit.kind == Edit::flip && may_flip(edit.h)) flip(edit.h);
  if (edit.kind == Edit::collapse && m_.opp[edit.h] >= 0 && !m_.hard[edit.h])
    collapse(edit.h, edit.gone, 1e9, 2);
  if (edit.kind == Edit::split) split(edit.h);
  return edits_.size() > before;
}

void Relaxer::settle(int times) {
  for (int i = 0; i < times; ++i) {
    flip_to_shape();
    smooth(3);
  }
}

double Relaxer::least_agreeing() const {
  double least = 1;
  for (int t = 0; t < (int)m_.tris.size(); ++t)
    if (!m_.dead(t)) least = std::min(least, agrees(m_.tris[t][0], m_.tris[t][1], m_.tris[t][2]));
  return least;
}

/// How far the middles of edges and triangles are from the reference, at most, in units of the size.
double Relaxer::farthest() const {
  double most = 0;
  // from each corner, whose sheet may end before the nearest place; a corner on a model edge knows but one
  // side
  auto look = [&](std::initializer_list<int> corners, Vec3 p) {
    double least = 1e300;
    for (int v : corners) {
      const Place nearest = ground_->walk.closest(lifted_.place[v], p, true);
      least = std::min(least, norm(ground_->walk.point(nearest) - p) / size_at(v));
    }
    most = std::max(most, least);
  };
  for (int t = 0; t < (int)m_.tris.size(); ++t) {
    if (m_.dead(t)) continue;
    const auto [a, b, c] = m_.tris[t];
    look({a, b, c}, (1.0 / 3) * (at(a) + at(b) + at(c)));
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (m_.opp[h] < h) look({m_.from(h), m_.to(h)}, 0.5 * (at(m_.from(h)) + at(m_.to(h))));
  }
  return most;
}

/// Does here what was done to a patch.
void Relaxer::adopt(const Relaxer& mended, std::vector<int> triangles, std::vector<int> vertices) {
  for (const Edit& e : mended.edits_) {
    const int h = 3 * triangles[e.h / 3] + e.h % 3;
    if (e.kind == Edit::flip) {
      flip(h);
    } else if (e.kind == Edit::split) {
      const int v = (int)vertices.size();
      for (int i = 0; i < (m_.opp[h] < 0 ? 1 : 2); ++i) triangles.push_back((int)m_.tris.size() + i);
      vertices.push_back((int)m_.out.size());
      insert(h, mended.lifted_.place[v], mended.at(v), mended.facing_[v]);
    } else {
      const int gone = vertices[e.gone], kept = m_.from(h) == gone ? m_.to(h) : m_.from(h);
      m_.collapse(h, gone);
      edited(kept);
      m_.neighbours(kept, [&](int v) { edited(v); });
      ++report_.collapses;
    }
  }
  for (int i = 0; i < (int)vertices.size(); ++i) {
    const char held = mended.held_[i];
    if (mended.m_.out[i] < 0 || held == frozen || (held == fixed && held_[vertices[i]] == fixed)) continue;
    held_[vertices[i]] = held;
    put(vertices[i], mended.lifted_.place[i], mended.at(i), mended.facing_[i]);
    touch(vertices[i]);
  }
  listed_ = false;
}

/// The flips, splits and collapses of the edges of t and of the triangles beside it; `wide`: of all that
/// share a vertex with it.
std::vector<Relaxer::Edit> Relaxer::edits_round(int t, bool wide) const {
  std::vector<int> halfedges;
  for (int s : wide ? triangles_round(t, 1) : std::vector<int>{t})
    for (int h = 3 * s; h < 3 * s + 3; ++h) {
      const int g = m_.opp[h];
      if (wide) {
        if (g < h) halfedges.push_back(h);
      } else {
        halfedges.push_back(h);
        if (g >= 0) halfedges.insert(halfedges.end(), {next(g), prev(g)});
      }
    }
  std::vector<Edit> edits;
  for (int h : halfedges) {
    edits.push_back({Edit::collapse, h, m_.from(h)});
    edits.push_back({Edit::collapse, h, m_.to(h)});
    edits.push_back({Edit::split, h, -1});
    if (!m_.hard[h]) edits.push_back({Edit::flip, h, -1});
  }
  return edits;
}

/// The best first, and no more than `most`.
void Relaxer::sort_trials(std::vector<Trial>& trials, std::size_t most) {
  for (Trial& t : trials) t.badness = t.state.badness();
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.badness < b.badness; });
  if (trials.size() > most) trials.erase(trials.begin() + (std::ptrdiff_t)most, trials.end());
}

/// Tries the edits round the first of these triangles, each on a copy of the neighbourhood and settled there,
/// and gives the best if it is better than what is. `thorough`: also pairs of edits, the second where the
/// best of the first leave their worst.
std::optional<Relaxer> Relaxer::mended(const std::vector<int>& triangles, bool thorough) const {
  // all settle a little, then the best of them quite
  auto try_all = [&](const Relaxer& from, const std::vector<Edit>& edits) {
    constexpr std::size_t promising = 8;
    std::vector<Trial> trials;
    for (const Edit& e : edits) {
      trials.push_back({0, from});
      if (trials.back().state.try_edit(e))
        trials.back().state.settle(1);
      else
        trials.pop_back();
    }
    sort_trials(trials, promising);
    for (Trial& t : trials) t.state.settle(1);
    sort_trials(trials, promising);
    return trials;
  };
  const Relaxer before = patch(triangles, vertices_of(triangles));
  const double bad = before.badness(), good_enough = bad - std::min(0.1 * bad, 0.05);
  const std::vector<Trial> trials = try_all(before, before.edits_round(0, thorough));
  if (trials.empty()) return {};
  Trial best = trials.front();
  for (std::size_t i = 0; i < 5 && i < trials.size() && thorough && best.badness > good_enough; ++i) {
    const Relaxer& from = trials[i].state;
    for (Trial& second : try_all(from, from.edits_round(from.worst(), false)))
      if (second.badness < best.badness) best = std::move(second);
  }
  if (best.badness > good_enough) return {};
  return std::move(best.state);
}

/// Has this been tried at t without success, when all round it were the edges that are? What only sweeps have
/// moved since is as it was.
bool Relaxer::in_vain(int t, const std::vector<int>& round, bool thorough) const {
  if (t >= (int)in_vain_[thorough].size()) return false;
  const int then = in_vain_[thorough][t];
  return then > 0 && std::all_of(round.begin(), round.end(), [&](int s) {
           return std::all_of(m_.tris[s].begin(), m_.tris[s].end(), [&](int v) { return edited_[v] < then; });
         });
}

/// Mends at each of these triangles, as long as it is wanted; returns how many changes that took.
/// Neighbourhoods that do not overlap are looked at together, in parallel; the rest wait for the next batch.
template <class Wanted>
int Relaxer::mend_each(std::vector<int> triangles, bool thorough, Wanted wanted) {
  struct Place {
    std::vector<int> round;
    std::optional<Relaxer> mended;
  };
  int changes = 0;
  while (!triangles.empty()) {
    std::vector<Place> batch;
    std::vector<int> rest;
    std::vector<char> taken(m_.tris.size());
    for (int t : triangles) {
      if (m_.dead(t) || !wanted(t)) continue;
      std::vector<int> round = triangles_round(t, thorough ? 3 : 2);
      if (in_vain(t, round, thorough)) continue;
      if (std::any_of(round.begin(), round.end(), [&](int s) { return taken[s]; })) {
        rest.push_back(t);
        continue;
      }
      for (int s : round) taken[s] = 1;
      batch.push_back({std::move(round), {}});
    }
    parallel_for((int)batch.size(), [&](int i) { batch[i].mended = mended(batch[i].round, thorough); });
    ++clock_;
    in_vain_[thorough].resize(m_.tris.size());
    for (Place& p : batch)
      if (p.mended)
        adopt(*p.mended, p.round, vertices_of(p.round)), ++changes;
      else
        in_vain_[thorough][p.round.front()] = clock_;
    triangles.swap(rest);
  }
  return changes;
}

int Relaxer::worst() const {
  std::pair<double, int> least{1e300, -1};
  for (int t = 0; t < (int)m_.tris.size(); ++t)
    if (!m_.dead(t)) least = std::min(least, {quality(t), t});
  return least.second;
}

/// By how much the valence of an inside vertex is off 5, 6 or 7.
int Relaxer::irregularity(int v) const {
  const bool inside = m_.out[v] >= 0 && (held_[v] == loose || held_[v] == anchored);
  return inside ? std::max(0, std::abs(excess(v)) - 1) : 0;
}

/// Mends the triangles that are not good enough, the worst first, then vertices of a valence that is none of
/// 5, 6, 7; only so many, since a mesh with more of them is not to be had by mending.
void Relaxer::mend_worst() {
  const int most = 200 + m_.live / 100;
  int before = 0, first = 0;
  for (int round = 0; round < (forced_ ? 1 : 4); ++round) {
    std::vector<std::pair<double, int>> bad;
    for (int t = 0; t < (int)m_.tris.size(); ++t)
      if (!m_.dead(t))
        if (const double q = quality(t); q < 1) bad.push_back({q, t});
    std::sort(bad.begin(), bad.end());
    const int many = (int)bad.size();
    // where the model or a border that is kept forces them they do not get fewer
    if (round == 0) first = many;
    forced_ = forced_ || (round > 1 && many > 100 && many > 0.8 * first);
    if (round > 1 && many > 100 && many > 0.98 * before) return;
    before = many;
    // far more than could be mended: what there is time for is the worst
    if (const int few = many > 4 * most ? most / 2 : most; many > few) bad.resize(few);
    std::vector<int> triangles, irregular;
    for (auto [q, t] : bad) triangles.push_back(t);
    int changes = mend_each(triangles, round > 0, [this](int t) { return quality(t) < 1; });
    for (int v = 0; v < (int)m_.out.size() && (int)irregular.size() < most; ++v)
      if (irregularity(v)) irregular.push_back(m_.out[v] / 3);
    changes += mend_each(irregular, false, [&](int t) {
      const Tri& v = m_.tris[t];
      return irregularity(v[0]) + irregularity(v[1]) + irregularity(v[2]) > 0;
    });
    if ((triangles.empty() && irregular.empty()) || (round > 0 && changes == 0)) return;
  }
}

/// Where triangles of the result intersect, but not of the reference, the surface is too thin or bends too
/// much for their size: refine there, and ask for smaller triangles from then on. Ends with the fewest
/// intersections it came to, when more rounds do not help.
void Relaxer::separate() {
  const int most = m_.live + m_.live / 4 + 1000;
  std::optional<Relaxer> best;
  std::optional<Mesh> known;
  for (int round = 0, since_best = 0;; ++round) {
    std::vector<int> number;
    const Mesh now = compact(number);
    report_.intersections = self_intersections(now);
    const int all = (int)report_.intersections.size();
    if (all > 0) {
      if (!known) known = contacts(ground_->surface, self_intersections(ground_->surface));
      report_.intersections = new_intersections(now, report_.intersections, *known);
    }
    report_.intersections_of_reference = all - (int)report_.intersections.size();
    for (auto& [s, t] : report_.intersections) s = number[s], t = number[t];
    if (report_.intersections.empty()) return;
    const bool better = !best || report_.intersections.size() < best->report_.intersections.size();
    since_best = better ? 0 : since_best + 1;
    if (since_best == 4 || round == 12 || m_.live > most) {
      if (!better) *this = *best;
      return;
    }
    if (better) best = *this;
    std::vector<int> culprits;
    for (auto [s, t] : report_.intersections) culprits.insert(culprits.end(), {s, t});
    auto unique = [](std::vector<int>& list) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    unique(culprits);
    std::vector<int> around;
    for (int t : culprits)
      for (int v : m_.tris[t]) {
        around.push_back(v);
        m_.neighbours(v, [&](int w) { around.push_back(w); });
      }
    unique(around);
    for (int v : around) {
      finer_[v] *= 0.8;
      touch(v);
    }
    for (int t : culprits) {
      int longest = -1;
      double length = 0;
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const double l = norm(at(m_.to(h)) - at(m_.from(h)));
        if (l > length) length = l, longest = h;
      }
      if (longest >= 0 && split(longest)) around.push_back((int)m_.out.size() - 1);
    }
    flip_to_shape();
    for (int repeat = 0; repeat < 3; ++repeat)
      for (int v : around) improve(v);
  }
}

}  // namespace meshpipe
