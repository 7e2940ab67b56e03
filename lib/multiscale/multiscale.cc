// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/multiscale.h"

#include <algorithm>
#include <numbers>

#include "lib/core/coarsen.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/core/union_find.h"
#include "lib/multiscale/cut_line.h"
#include "lib/multiscale/reach_holes.h"

namespace meshpipe {
namespace {

constexpr int directions = 4;         // of the line in the root's disk
constexpr double least_share = 0.02;  // of the area: a smaller half is no progress

/// Gives the pieces of each side, except its largest, to the other side; then both are in one piece. Pieces
/// are those of the vertices of one sign under the edges between them: no value is zero, so the sides that
/// the cut makes have the same connectivity.
void drop_fragments(const ConnectedPart& part, std::vector<double>& field) {
  const int n = (int)field.size();
  UnionFind pieces(0);
  bool changed = true;
  for (bool positive : {true, false}) {
    if (changed) pieces = UnionFind(n);
    for (int h = 0; h < (int)part.opposite.size() && changed; ++h) {
      const int u = origin(part.tris, h), v = target(part.tris, h);
      if (part.opposite[h] <= h && (field[u] > 0) == (field[v] > 0)) pieces.join(u, v);  // every edge once
    }
    std::vector<int> size(n, 0);
    int largest = -1;
    for (int v = 0; v < n; ++v) {
      if ((field[v] > 0) != positive) continue;
      const int r = pieces.find(v);
      if (++size[r]; largest < 0 || size[r] > size[largest]) largest = r;
    }
    std::vector<int> fragments;
    for (int v = 0; v < n; ++v)
      if ((field[v] > 0) == positive && pieces.find(v) != largest) fragments.push_back(v);
    for (int v : fragments) field[v] = -field[v];
    changed = !fragments.empty();
  }
}

/// Fewest holes left, then a short cut between halves of like size.
bool better(const Assessment& a, const Assessment& b) {
  if (a.valid != b.valid) return a.valid;
  if (a.loops != b.loops) return a.loops < b.loops;
  auto cost = [](const Assessment& x) { return x.length * (1 + 4 * std::max(0., 0.3 - x.smaller_share)); };
  return cost(a) < cost(b);
}

/// A line, and what it does.
struct Candidate {
  Assessment is;
  std::vector<double> field;
  std::vector<std::vector<Vec2>> lines;
};

/// The best of the lines in all directions; with a field of one sign if none is any good.
Candidate best_line(const ConnectedPart& part, const CutMaps& cut) {
  std::vector<Candidate> candidates(directions);
  constexpr std::size_t worth_threads = 4000;  // triangles: below it starting threads takes longer
  auto try_direction = [&](int i) {
    Candidate& c = candidates[i];
    c.lines = cut_lines(cut.disk, cut.levels, std::numbers::pi * i / directions);
    c.field = cut_line_field(cut.disk, cut.levels, c.lines);
    drop_fragments(part, c.field);
    c.is = assess(part, c.field);
  };
  parallel_for(directions, try_direction, part.tris.size() > worth_threads);
  Candidate& best = *std::min_element(candidates.begin(), candidates.end(),
                                      [](const auto& a, const auto& b) { return better(a.is, b.is); });
  if (!best.is.valid || best.is.smaller_share < least_share) best.field.assign(best.field.size(), 1);
  return std::move(best);
}

/// The best line of a part itself.
CutMaps best_cut_of(const ConnectedPart& part, double share) {
  CutMaps cut;
  cut.disk = fill_holes(part);
  cut.levels = laplace_levels(cut.disk);
  add_progress(0.4 * share);
  Candidate best = best_line(part, cut);
  reach_holes(cut.disk, {part, part.opposite}, best.field);
  drop_fragments(part, best.field);
  cut.field = std::move(best.field);
  cut.lines = std::move(best.lines);
  add_progress(0.3 * share);
  return cut;
}

}  // namespace

Assessment assess(const ConnectedPart& part, const std::vector<double>& field) {
  const std::vector<Vec3>& p = part.points;
  Assessment a;
  int chi[2] = {0, 0};
  double area[2] = {0, 0};
  UnionFind sides(field.size());
  int pieces = (int)field.size();
  for (double f : field) ++chi[f > 0];
  if (chi[0] == 0 || chi[1] == 0) return a;
  for (std::size_t t = 0; t < part.tris.size(); ++t) {
    const Tri& c = part.tris[t];
    const double third = norm(area_vector(p[c[0]], p[c[1]], p[c[2]])) / 6;
    Vec3 crossing[2];
    int crossings = 0, positive = 0;
    for (int k = 0; k < 3; ++k) {
      const int u = c[k], v = c[(k + 1) % 3], h = 3 * (int)t + k;
      positive += field[u] > 0;
      area[field[u] > 0] += third;
      if ((field[u] > 0) != (field[v] > 0)) {
        crossing[crossings++ & 1] = lerp(p[u], p[v], field[u] / (field[u] - field[v]));
      } else if (part.opposite[h] <= h) {  // every edge once
        --chi[field[u] > 0];
        pieces -= sides.join(u, v);
      }
    }
    if (crossings == 2) a.length += norm(crossing[1] - crossing[0]);
    if (positive % 3 == 0) ++chi[positive == 3];
  }
  a.valid = pieces == 2;
  a.loops = 4 - chi[0] - chi[1];
  a.smaller_share = std::min(area[0], area[1]) / (area[0] + area[1]);
  return a;
}

CutMaps best_cut(const ConnectedPart& part, double share, std::vector<double>& field) {
  constexpr int enough = 12000, at_most = 6;  // triangles; of them for one
  constexpr double most_turn = 25 * std::numbers::pi / 180;
  constexpr double worth = 2.5;  // what has thin branches is not made coarse: they need all edges
  const double n = (double)part.tris.size();
  Coarse coarse;
  if (n > worth * enough)
    coarse = coarsen({part, part.opposite}, std::max(enough, (int)(n / at_most)), {most_turn});
  if (coarse.tris.empty() || n < worth * (double)coarse.tris.size()) {
    CutMaps cut = best_cut_of(part, share);
    field = cut.field;
    return cut;
  }
  // the sides that coarse vertices give to those that have become them have as many pieces
  ConnectedPart model{{coarse, {}, {}}, opposite_halfedges(coarse), {}};
  CutMaps cut = best_cut_of(model, share);
  field = rearranged(cut.field, coarse.of);
  return cut;
}

}  // namespace meshpipe
