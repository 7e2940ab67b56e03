// SPDX-License-Identifier: BSD-3-Clause
// Tips and ridges of the reference that the mesh cuts off.
#include <algorithm>
#include <cmath>
#include <optional>

#include "lib/bvh.h"
#include "lib/parallel.h"
#include "lib/relaxer.h"
#include "lib/size.h"

namespace meshpipe {

/// The places of the reference that a mesh with edges of length h is likely to cut off: its vertices, and
/// where it bends, points on its edges at most h / 3 apart.
std::vector<Tip> Ground::likely_tips(double h) const {
  constexpr double bends = 0.985;  // 10 degrees
  const std::vector<Vec3>& p = surface.points;
  std::vector<Tip> tips(p.size());
  for (int t = 0; t < (int)surface.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      tips[surface.tris[t][i]] = {{t, i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}};
  std::erase_if(tips, [](const Tip& tip) { return tip.place.face < 0; });  // of no triangle
  for (int t = 0; t < (int)surface.tris.size(); ++t) {
    const Tri& v = surface.tris[t];
    for (int i = 0; i < 3; ++i) {
      const int a = v[i], b = v[(i + 1) % 3],
                pieces = (int)std::min(50.0, std::ceil(3 * norm(p[b] - p[a]) / h));
      if (a > b || pieces < 2) continue;
      const Vec3 n = normalized(area_vector(p[v[0]], p[v[1]], p[v[2]]));
      if (dot(n, normalized(normals[a])) > bends && dot(n, normalized(normals[b])) > bends) continue;
      for (int k = 1; k < pieces; ++k) {
        double at[3] = {0, 0, 0};
        at[(i + 1) % 3] = (double)k / pieces, at[i] = 1 - at[(i + 1) % 3];
        tips.push_back({{t, at[0], at[1], at[2]}});
      }
    }
  }
  tips.shrink_to_fit();
  return tips;
}

/// Tips and ridges that the mesh cuts off are where it is farthest from the reference. Where they are farther
/// than a tenth of the size, the farthest first, a mesh vertex goes there and stays. True if one was reached.
bool Relaxer::reach_tips(std::vector<Tip>& tips) {
  if (m_.live == 0 || tips.empty()) return false;
  std::vector<int> number;
  const Mesh now = compact(number);
  const double h = size_for_count(total_area(now), now.tris.size());
  const int n = (int)tips.size();
  std::vector<double> distance(n, 1e300);  // at most, and exact where it is more than `enough`
  const Bvh tree(now);
  auto look = [&](double enough) {
    constexpr int chunk = 256;
#pragma omp parallel for schedule(dynamic) if (n > 10000)
    for (int first = 0; first < n; first += chunk)
      for (int i = first; i < std::min(n, first + chunk); ++i) {
        if (distance[i] <= enough) continue;
        Tip& tip = tips[i];
        const Vec3 p = ground_->walk.point(tip.place);
        // most are still near to the triangle that they were near to, or to that of the tip before
        if ((tip.near < 0 || m_.dead(tip.near)) && i > first) tip.near = tips[i - 1].near;
        if (tip.near >= 0 && !m_.dead(tip.near)) {
          distance[i] = walk_near(p, tip.near, enough);
          if (distance[i] <= enough) continue;
        }
        const Bvh::Hit hit = tree.nearest(p, distance[i], enough);
        tip.near = number[hit.place.face];
        distance[i] = hit.distance;
      }
  };
  // the farthest are all that is wanted: the others need not be known any better
  double far_enough = 0, enough = 0.5 * h;
  for (;; enough = std::max(0.1 * h, 0.5 * enough)) {
    look(enough);
    far_enough = std::max(0.1 * h, 0.7 * *std::max_element(distance.begin(), distance.end()));
    if (enough <= far_enough) break;
  }
  std::vector<std::pair<double, int>> farthest;  // the distance, negative, and the tip
  for (int i = 0; i < n; ++i) {
    if (distance[i] <= far_enough) continue;
    // where the size is larger than elsewhere, so is the distance that it stands for
    const double here = size_at(m_.tris[tips[i].near][0]) / h;
    if (distance[i] > far_enough * (here > 1.2 ? here : 1)) farthest.push_back({-distance[i], i});
  }
  std::sort(farthest.begin(), farthest.end());
  bool any = false;
  int left = std::max(4, (int)now.tris.size() / 800);  // more would cost the mesh its regularity
  struct Try {
    const Place* tip;
    int t;
    double least;
    Vec3 q;
    std::vector<int> round;
    std::optional<Relaxer> state;
  };
  // neighbourhoods that do not overlap are looked at together, in parallel; the rest wait for the next batch
  while (!farthest.empty() && left > 0) {
    std::vector<Try> batch;
    std::vector<std::pair<double, int>> rest;
    std::vector<char> taken(m_.tris.size());
    for (const auto& next : farthest) {
      if ((int)batch.size() == left) {
        rest.push_back(next);
        continue;
      }
      const Tip& tip = tips[next.second];
      if (int t = tip.near;
          m_.dead(t) || walk_near(ground_->walk.point(tip.place), t, far_enough) <= far_enough)
        continue;
      Try one{&tip.place, tip.near, 0, {}, {}, {}};
      one.least = nearest_triangle(ground_->walk.point(tip.place), one.t, one.q);
      if (one.least <= far_enough) continue;
      one.round = triangles_round(one.t, 2);
      if (std::any_of(one.round.begin(), one.round.end(), [&](int s) { return taken[s]; })) {
        rest.push_back(next);
        continue;
      }
      for (int s : one.round) taken[s] = 1;
      batch.push_back(std::move(one));
    }
    parallel_for((int)batch.size(), [&](int k) {
      Try& one = batch[k];
      one.state = reached(*one.tip, one.q, one.least, far_enough, one.round);
    });
    for (Try& one : batch)
      if (one.state) {
        adopt(*one.state, one.round, vertices_of(one.round));
        --left, any = true;
      }
    farthest.swap(rest);
  }
  return any;
}

/// The distance of p from the triangle that a walk from t, which becomes that, ends at: the nearest, as far
/// as a walk can tell, or the first that is within `enough`.
double Relaxer::walk_near(Vec3 p, int& t, double enough) const {
  double least = 1e300;
  for (int s = t;;) {
    const auto [a, b, c] = m_.tris[s];
    const auto w = closest_on_triangle(p, at(a), at(b), at(c));
    const double d = norm(w[0] * at(a) + w[1] * at(b) + w[2] * at(c) - p);
    if (!(d < least)) return least;
    least = d, t = s;
    const int i = w[0] <= 0 ? 1 : w[1] <= 0 ? 2 : 0;  // the edge opposite to a corner without weight
    if (d <= enough || w[(i + 2) % 3] > 0 || m_.opp[3 * s + i] < 0) return least;
    s = m_.opp[3 * s + i] / 3;
  }
}

/// The triangle nearest to p of those round t, which it becomes, its nearest point q and the distance.
double Relaxer::nearest_triangle(Vec3 p, int& t, Vec3& q) const {
  double least = 1e300;
  for (int s : triangles_round(t, 2)) {
    const Tri& v = m_.tris[s];
    const auto b = closest_on_triangle(p, at(v[0]), at(v[1]), at(v[2]));
    const Vec3 x = b[0] * at(v[0]) + b[1] * at(v[1]) + b[2] * at(v[2]);
    if (const double d = norm(x - p); d < least) least = d, t = s, q = x;
  }
  return least;
}

/// The neighbourhood `round` of a triangle with a vertex of that at `tip`, or a new one on one of its edges,
/// whichever leaves the better mesh when all round it has settled. q: the nearest point of the mesh, at
/// distance `least`. One of the farthest tips that would spoil the mesh is gone half way to. None if the tip
/// cannot be walked to, or would spoil the mesh.
std::optional<Relaxer> Relaxer::reached(const Place& tip, Vec3 q, double least, double far_enough,
                                        const std::vector<int>& round) const {
  if (auto state = gone_to(tip, least, round)) return state;
  if (least < 1.2 * far_enough) return {};
  const Vec3 p = ground_->walk.point(tip), half = lerp(q, p, 0.5);
  const Place along = ground_->walk.slide(tip, half);  // stays if the tip is on no border
  const bool moved = norm(ground_->walk.point(along) - p) > 0.1 * least;
  return gone_to(moved ? along : ground_->walk.closest(tip, half), least, round);
}

/// Does so for any place; `least`: the distance from the mesh that it may not grow to near by.
std::optional<Relaxer> Relaxer::gone_to(const Place& tip, double least, const std::vector<int>& round) const {
  const int t = round.front();
  // about one triangle with nine tenths of the quality wanted, for a tip a tenth of the size out; more
  // farther
  const double spoils = 1.8e-3 * std::pow(std::clamp(least / (0.1 * size_at(m_.tris[t][0])), 1.0, 5.0), 1.5);
  const Vec3 p = ground_->walk.point(tip);
  // along: on a border or model edge
  auto reaches = [&](int v, bool along) {
    const Place& from = lifted_.place[v];
    const Place to = along ? ground_->walk.slide(from, p) : ground_->walk.closest(from, p);
    return norm(ground_->walk.point(to) - p) < 1e-6 * size_at(v);
  };
  const Relaxer before = patch(round, vertices_of(round));
  const double near_enough = std::max(before.farthest(), least / size_at(m_.tris[t][0]));
  const double bearable = before.badness() + spoils;
  constexpr std::size_t promising = 3;
  std::vector<Trial> trials;
  // by a vertex of the triangle nearest to it, then by a new one on an edge of that
  for (int i = 0; i < 6; ++i) {
    const int h = i % 3, from = m_.tris[t][h], to = m_.tris[t][(h + 1) % 3];
    const bool hard = before.m_.hard[h], seam = held_[from] == paired && held_[to] == paired;
    const bool stays = i < 3 ? held_[from] != loose && held_[from] != slides
                             : hard && (seam || (before.m_.opp[h] >= 0 && this->on_line(from, to) < 0));
    const bool on_line = i < 3 ? held_[from] == slides : hard;
    if (stays || !(reaches(from, on_line) || (i >= 3 && hard && reaches(to, true)))) continue;
    Relaxer& after = trials.emplace_back(Trial{0, before}).state;
    int v = after.m_.from(h);
    if (i >= 3) {
      v = (int)after.m_.out.size();
      after.insert(h, tip, p, {});
    }
    after.put(v, tip, p, on_line && !after.m_.on_border(v) ? Vec3{} : facing_at(tip));
    after.held_[v] = on_line ? fixed : anchored;
    after.listed_ = false;
    after.settle(1);
  }
  sort_trials(trials, promising);
  for (Trial& t : trials) t.state.settle(1);
  sort_trials(trials, promising);
  for (Trial& t : trials)
    if (t.badness < bearable && t.state.least_agreeing() > 0 && t.state.farthest() <= near_enough)
      return std::move(t.state);
  return {};
}

}  // namespace meshpipe
