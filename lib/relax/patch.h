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

/// Returns the quality of triangle t: 1 or more if it is good enough (kappa 0.75, 35 degrees and, where it
/// may be asked, 86 degrees), 0 if it is folded.
double quality(const State& s, int t);
/// Returns the point of triangle t nearest to p.
Vec3 nearest_point(const State& s, int t, Vec3 p);
/// Returns by how much the valence of a vertex that may move is off 5 to 7 (on a border 3 to 5); else 0.
int irregularity(const State& s, int v);
/// Returns what trials minimize: a sum over triangles of their lack of quality, in which the worst count most
/// and those that are good with a margin not at all, plus a little per irregularity.
double objective(const State& s);
/// Returns the triangle of least quality.
int worst(const State& s);
/// Returns the largest distance of the centroid of triangle t and of the midpoints of its edges from the
/// reference, in units of the size. An edge counts with the triangle of its larger half-edge.
double deviation(const State& s, int t);
/// Returns the largest deviation of all triangles.
double deviation(const State& s);

/// Returns whether two edges of these triangles join the same vertices. Components of few triangles have such
/// edges, which no patch can tell apart.
bool has_double_edge(const EditMesh& mesh, const std::vector<int>& triangles);

/// Returns triangle t, then those up to `rings` vertices away from it, on other sheets too.
std::vector<int> triangles_around(const State& s, int t, int rings);
/// Copies these triangles to a mesh of its own, whose rim is frozen and which records its edits. Its vertices
/// are those of the triangles, in ascending order.
State extract(const State& s, const std::vector<int>& triangles);
/// Flips for shape and smooths, `times` times.
void settle(State& s, int times);
/// Marks everything as settled: only what changes from now on, and what is around it, is tried again.
void rest(State& s);
/// Repeats in s the edits of the patch extracted from these triangles, then moves its vertices.
void adopt(State& s, const State& patch, std::vector<int> triangles);
/// The objective that trials minimize, or any number over `bound` where it is over that, asked for by several
/// threads at once; whether splits may fold what smoothing may unfold; and around how many triangles of a
/// patch, its first, edits are tried.
struct Judge {
  std::function<double(const State&, double bound)> of = [](const State& s, double) { return objective(s); };
  bool may_fold = false;
  int at = 1;
};
/// Evaluates the trials by the judge and keeps the `most` best, the best first. Requires: most > 0.
void keep_best(std::vector<Trial>& trials, std::size_t most, const Judge& judge = {});

/// Changes neighborhoods until `most` were adopted or `attempts` were tried. Those that do not overlap are
/// tried together, in parallel; the rest wait for the next batch.
///   around(item, before): the triangles to change; none: it is no longer wanted; `before`: what it returned
///     for the last batch if no change was adopted since, else empty
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
