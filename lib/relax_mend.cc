// SPDX-License-Identifier: BSD-3-Clause
// The few places that need more than sweeps: tips that the mesh cuts off, the worst triangles, intersections.
#include <algorithm>
#include <cmath>

#include "lib/bvh.h"
#include "lib/intersect.h"
#include "lib/relaxer.h"

namespace meshpipe {

/// Tips and ridges that the mesh cuts off are where it is farthest from the reference. For the vertices of
/// the reference that lie farther than a tenth of the size, the farthest first, the mesh vertex nearest by
/// goes there and stays, if it can walk there and leaves its star in good shape.
void Relaxer::reach_tips() {
  std::vector<int> number;
  const Mesh now = compact(number);
  if (now.tris.empty()) return;
  const Bvh tree(now);
  const int n = (int)reference_.points.size();
  std::vector<Bvh::Hit> hit(n);
#pragma omp parallel for schedule(static) if (n > 10000)
  for (int v = 0; v < n; ++v) hit[v] = tree.nearest(reference_.points[v]);
  const double h = std::sqrt(4 / sqrt3 * total_area(now) / (double)now.tris.size());
  double farthest = 0;
  for (int v = 0; v < n; ++v) farthest = std::max(farthest, hit[v].distance);
  const double far_enough = std::max(0.1 * h, 0.5 * farthest);
  std::vector<std::pair<double, int>> far;
  for (int v = 0; v < n; ++v)
    if (hit[v].distance > far_enough) far.push_back({-hit[v].distance, v});
  std::sort(far.begin(), far.end());
  int left = (int)now.tris.size() / 400;  // more would cost the mesh its regularity
  for (auto [minus_distance, v] : far) {
    if (left == 0) break;
    const Vec3 tip = reference_.points[v];
    int nearest = -1;
    for (int w : m_.tris[number[hit[v].place.face]])
      if (held_[w] == loose && (nearest < 0 || norm(at(w) - tip) < norm(at(nearest) - tip))) nearest = w;
    Star star;
    if (nearest < 0 || !gather(nearest, star)) continue;
    const Place place = walk_.closest(lifted_.place[nearest], tip);
    const Vec3 p = walk_.point(place), facing = facing_at(place);
    if (norm(p - tip) > 1e-6 * h) continue;
    double worst = 0;
    for (int i = 0; i < star.n; ++i) worst = std::max(worst, shape_energy(p, star.y[i], star.z[i]));
    if (worst > 1.9 || folds(star.agreement(at(nearest), facing_[nearest]), star.agreement(p, facing)))
      continue;
    put(nearest, place, p, facing);
    held_[nearest] = anchored;
    listed_ = false;
    --left;
    touch(nearest);
  }
  smooth(3);
  flip_to_shape();
  smooth(2);
}

/// Triangles of low quality one by one: whatever of flip, collapse, split and moves of the neighbourhood
/// helps.
void Relaxer::mend_worst() {
  for (int round = 0; round < 6; ++round) {
    std::vector<std::pair<double, int>> bad;
    for (int t = 0; t < (int)m_.tris.size(); ++t)
      if (!m_.dead(t))
        if (double k = kappa_of(t); k < 0.7) bad.push_back({k, t});
    if (bad.empty()) return;
    std::sort(bad.begin(), bad.end());
    for (auto [k, t] : bad) {
      if (m_.dead(t) || kappa_of(t) > 0.75) continue;
      for (int h = 3 * t; h < 3 * t + 3; ++h)
        if (!m_.hard[h] && worst_flipped(h) < 0.95 * worst_now(h) && may_flip(h)) flip(h);
      if (kappa_of(t) < 0.5) {
        int shortest = 3 * t;
        for (int h = 3 * t; h < 3 * t + 3; ++h)
          if (norm(at(m_.to(h)) - at(m_.from(h))) < norm(at(m_.to(shortest)) - at(m_.from(shortest))))
            shortest = h;
        if (collapse_either(shortest, 1, 1.8)) continue;
      }
      for (int repeat = 0; repeat < 2; ++repeat)
        for (int v : m_.tris[t]) {
          improve(v);
          m_.neighbours(v, [&](int w) { improve(w); });
        }
    }
  }
}

/// Where triangles of the result intersect, the surface is too thin or bends too much for their size: refine
/// there, and ask for smaller triangles from then on. Gives up when that does not help.
void Relaxer::separate() {
  const int most = m_.live + m_.live / 4 + 1000;
  for (int round = 0;; ++round) {
    std::vector<int> number;
    const Mesh now = compact(number);
    report_.intersections = self_intersections(now);
    std::vector<int> culprits;
    for (auto& [s, t] : report_.intersections) {
      s = number[s], t = number[t];
      culprits.insert(culprits.end(), {s, t});
    }
    if (culprits.empty() || round == 12 || m_.live > most) return;
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
        if (!m_.hard[h] && l > length) length = l, longest = h;
      }
      if (longest >= 0 && split(longest)) around.push_back((int)m_.out.size() - 1);
    }
    flip_to_shape();
    for (int repeat = 0; repeat < 3; ++repeat)
      for (int v : around) improve(v);
  }
}

}  // namespace meshpipe
