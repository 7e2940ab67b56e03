// SPDX-License-Identifier: BSD-3-Clause
// Changes on trial: a neighborhood is cut out of the mesh, changed and judged there, and adopted if it got
// better; for lib/relax/ only.
#pragma once
#include <climits>
#include <functional>
#include <optional>

#include "lib/core/parallel.h"
#include "lib/relax/operations.h"

namespace meshpipe {

/// A neighborhood changed on trial.
struct Trial {
  double objective;
  State state;
};

/// 1 for a triangle that is good enough: kappa 0.75, 35 degrees and, where it may be asked, 86; 0 for one
/// that is folded over.
double quality(const State& s, int t);
/// The point of triangle t nearest to p.
Vec3 nearest_point(const State& s, int t, Vec3 p);
/// By how much the valence of an inside vertex is off 5, 6 or 7.
int irregularity(const State& s, int v);
/// What trials make small: a sum over triangles that counts the worst most, and none that is good with a
/// margin; and over inside vertices whose valence is not 5, 6 or 7.
double objective(const State& s);
/// The triangle of least quality.
int worst(const State& s);
/// The largest distance of the middles of triangle t and its edges from the reference, over the size. An edge
/// counts with the triangle of its larger half-edge.
double deviation(const State& s, int t);
/// The largest of all triangles.
double deviation(const State& s);

/// Do two edges of these triangles join the same vertices? Components of few triangles have such edges, which
/// no patch can tell apart.
bool has_double_edge(const EditMesh& mesh, const std::vector<int>& triangles);

/// Triangle t, then those that are up to `rings` vertices away, on other sheets too.
std::vector<int> triangles_around(const State& s, int t, int rings);
/// These triangles as a mesh of its own whose rim is frozen, and which records its edits. Its vertices are
/// those of the triangles, ascending.
State extract(const State& s, const std::vector<int>& triangles);
/// Flips for shape and smooths, a few times.
void settle(State& s, int times);
/// Takes everything for settled: only what is changed from now on, and what is around it, is tried again.
void rest(State& s);
/// Repeats in s what was done to the patch extracted from these triangles, and moves its vertices.
void adopt(State& s, const State& patch, std::vector<int> triangles);
/// What trials make small, and whether splits may fold what smoothing may unfold.
struct Judge {
  std::function<double(const State&)> of = objective;
  bool may_fold = false;
};
/// Evaluates the trials and keeps the best `most` of them, the best first.
void keep_best(std::vector<Trial>& trials, std::size_t most, const Judge& judge = {});

/// Changes neighborhoods until `most` were adopted or `attempts` were tried. Those that do not overlap are
/// tried together, in parallel; the rest wait for the next batch.
///   around(item, before): the triangles to change; none: it is no longer wanted; `before`: what it returned
///   for
///     the last batch if no change was adopted since, else empty
///   attempt(item, triangles): the patch to adopt, if any
///   failed(triangles): called where there was none
/// Returns: the number adopted.
template <class Item, class Around, class Attempt, class Failed>
int change_neighborhoods(State& s, const std::vector<Item>& items, int most, int attempts, Around around,
                         Attempt attempt, Failed failed) {
  struct Change {
    Item item;
    std::vector<int> triangles;
    std::optional<State> patch;
  };
  std::vector<Change> waiting;
  for (const Item& item : items) waiting.push_back({item, {}, {}});
  int adopted = 0;
  while (!waiting.empty() && adopted < most && attempts > 0) {
    std::vector<Change> batch, rest;
    std::vector<char> taken(s.mesh.tris.size());
    for (Change& c : waiting) {
      const bool full = (int)batch.size() == std::min(most - adopted, attempts);
      if (!full && (c.triangles = around(c.item, std::move(c.triangles))).empty()) continue;
      if (full || std::any_of(c.triangles.begin(), c.triangles.end(), [&](int t) { return taken[t]; })) {
        rest.push_back(std::move(c));
        continue;
      }
      for (int t : c.triangles) taken[t] = 1;
      batch.push_back(std::move(c));
    }
    parallel_for((int)batch.size(),
                 [&](int i) { batch[i].patch = attempt(batch[i].item, batch[i].triangles); });
    ++s.clocks.now;
    const int before = adopted;
    for (const Change& c : batch)
      if (c.patch)
        adopt(s, *c.patch, c.triangles), ++adopted;
      else
        failed(c.triangles);
    attempts -= (int)batch.size();
    waiting.swap(rest);
    if (adopted > before)
      for (Change& c : waiting) c.triangles.clear();
  }
  return adopted;
}

}  // namespace meshpipe
