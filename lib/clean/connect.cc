// SPDX-License-Identifier: BSD-3-Clause
// Neighbors, orientation and fans of a surface under repair.
#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "lib/clean/repair.h"
#include "lib/core/edges.h"
#include "lib/core/lists.h"
#include "lib/core/topology.h"

namespace meshpipe {

void join(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options, CleanReport& report) {
  const int n = (int)r.vertex.size();
  std::vector<char> gone;
  std::vector<EdgeUse> third;
  std::vector<std::array<int, 2>> same;  // triangles of the same vertices, the first and a later one
  std::vector<int> many;                 // triangles on non-manifold edges
  int edges = 0;
  for (bool again = true; again;) {
    edges = 0;
    same.clear();
    many.clear();
    r.split.assign(n, 0);
    r.opposite.assign(3 * r.tris.size(), -1);
    for_each_edge(r.tris, n, [&](std::span<const EdgeUse> uses) {
      if (uses.size() < 2) return;
      const int h = half_edge(uses[0]), g = half_edge(uses[1]);
      third.clear();
      const bool differ = uses.size() == 2 && origin(r.tris, prev(h)) != origin(r.tris, prev(g));
      for (EdgeUse e : differ ? std::span<const EdgeUse>() : uses)
        third.push_back((EdgeUse)origin(r.tris, prev(half_edge(e))) << 32 | (std::uint32_t)half_edge(e));
      std::sort(third.begin(), third.end());
      for (std::size_t i = 1, first = 0; i < third.size(); ++i)
        if (third[i] >> 32 == third[first] >> 32)
          same.push_back({half_edge(third[first]) / 3, half_edge(third[i]) / 3});
        else
          first = i;
      if (uses.size() > 2 || (options.keep_orientation && origin(r.tris, h) == origin(r.tris, g))) {
        ++edges;
        for (EdgeUse e : uses) many.push_back(half_edge(e) / 3);
        r.split[origin(r.tris, h)] = r.split[target(r.tris, h)] = 1;
      } else {
        r.opposite[h] = g;
        r.opposite[g] = h;
      }
    });
    again = false;
    if (same.empty() && edges == 0) break;
    gone.assign(r.tris.size(), 0);
    const int contacts = drop_doubles(r, points, same, options.sheets, gone);
    for (const auto& [t, u] : same)
      if (gone[u] && !gone[t] && r.face[t] >= 0 && r.face[u] >= 0)
        report.sheets.doubles.push_back({r.face[t], r.face[u]});
    for (std::size_t t = 0; t < gone.size(); ++t)
      if (gone[t]) {
        report.duplicate += r.face[t] >= 0;
        record(report, r.face[t], Fault::duplicate);
        again = true;
      }
    if (again) {
      r.opposite.clear();
      drop(r, gone);
    } else {
      report.contacts = contacts;
    }
  }
  report.opened_edges = edges;
  if (report.nonmanifold_edges) return;
  report.nonmanifold_edges = edges;
  for (int t : many) record(report, r.face[t], Fault::nonmanifold);
}

namespace {

enum Side : char { unseen, as_seed, against };
char other(char side) { return side == as_seed ? against : as_seed; }

/// Whether the triangles on both sides of an edge would be oriented consistently.
bool agree(const Repair& r, const std::vector<char>& side, int h) {
  const int g = r.opposite[h];
  return (origin(r.tris, h) != origin(r.tris, g)) == (side[h / 3] == side[g / 3]);
}

/// Makes the lines shorter where sides disagree: a triangle goes to the other side if more of its border is
/// on such a line than not. Returns their length.
double shorten(const Repair& r, const std::vector<Vec3>& points, const std::vector<int>& members,
               std::vector<char>& side) {
  auto length = [&](int h) {
    return norm(point(r, points, origin(r.tris, h)) - point(r, points, target(r.tris, h)));
  };
  for (std::vector<int> todo = members; !todo.empty();) {
    const int t = take_last(todo);
    double gain = 0, around = 0;
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (r.opposite[h] >= 0) gain += agree(r, side, h) ? -length(h) : length(h), around += length(h);
    if (!(gain > 1e-9 * around)) continue;  // rounding must not let it go back and forth
    side[t] = other(side[t]);
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (r.opposite[h] >= 0) todo.push_back(r.opposite[h] / 3);
  }
  double sum = 0;
  for (int t : members)
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (h < r.opposite[h] && !agree(r, side, h)) sum += length(h);
  return sum;
}

/// Opens a component that is not orientable along short lines: where its orientation changes as it is, or
/// where sides that grew from one triangle disagree if that is shorter.
void cut_open(Repair& r, const std::vector<Vec3>& points, const std::vector<int>& members,
              std::vector<char>& side, FlipCounts& flips) {
  std::vector<char> spare;
  for (int t : members) spare.push_back(std::exchange(side[t], as_seed));
  const double as_it_is = shorten(r, points, members, side);
  for (std::size_t i = 0; i < spare.size(); ++i) std::swap(spare[i], side[members[i]]);
  if (as_it_is <= shorten(r, points, members, side))
    for (std::size_t i = 0; i < spare.size(); ++i) side[members[i]] = spare[i];
  flips.triangles += (int)members.size();
  for (int t : members)
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (r.opposite[h] < 0 || agree(r, side, h)) continue;
      const int a = origin(r.tris, h), b = target(r.tris, h);
      if (flips.edges++ == 0) flips.place = lerp(points[r.vertex[a]], points[r.vertex[b]], 0.5);
      r.split[a] = r.split[b] = 1;
      r.opposite[h] = r.opposite[r.opposite[h]] = -1;
    }
}

}  // namespace

void orient(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options, std::vector<char>& gone,
            CleanReport& report) {
  const int n = (int)r.tris.size();
  bool consistent = true;
  report.sheets.flips = {};
  for (int h = 0; consistent && h < 3 * n; ++h)
    consistent = r.opposite[h] < 0 || origin(r.tris, h) != origin(r.tris, r.opposite[h]);
  if (consistent) return;
  std::vector<char> side(n, unseen);
  std::vector<int> members;
  gone.assign(n, 0);
  for (int seed = 0; seed < n; ++seed) {
    if (side[seed] != unseen) continue;
    side[seed] = as_seed;
    members.assign(1, seed);
    bool orientable = true;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const int t = members[i];
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int u = r.opposite[h] / 3;
        if (r.opposite[h] < 0) continue;
        if (side[u] == unseen) {
          members.push_back(u);
          side[u] = origin(r.tris, h) != origin(r.tris, r.opposite[h]) ? side[t] : other(side[t]);
        }
        orientable = orientable && agree(r, side, h);
      }
    }
    if (!orientable && options.drop_nonorientable) {
      report.nonorientable.push_back({source(r, seed), (int)members.size()});
      for (int t : members) {
        gone[t] = 1;
        record(report, r.face[t], Fault::nonorientable);
      }
      continue;
    }
    if (!orientable) cut_open(r, points, members, side, report.sheets.flips);
    std::size_t reversed = 0;
    for (int t : members) reversed += side[t] == against;
    const char wrong = 2 * reversed > members.size() ? as_seed : against;
    for (int t : members)
      if (side[t] == wrong) flip(r, t);
  }
}

void split_fans(Repair& r, CleanReport& report) {
  const int n = (int)r.vertex.size();
  std::vector<char> seen(r.opposite.size(), 0);
  enum : char { none, one, many };
  std::vector<char> fans(n, none);
  std::vector<int> fan, apart;  // triangles of further fans, except those on split edges
  int vertices = 0;
  for (int seed = 0; seed < (int)r.opposite.size(); ++seed) {
    if (seen[seed]) continue;
    fan.clear();
    for_each_spoke(r.opposite, seed, [&](int g) { fan.push_back(g); });
    for (int g : fan) seen[g] = 1;
    const int v = origin(r.tris, seed);
    if (fans[v] != none) {
      vertices += fans[v] == one;
      for (int g : fan) {
        r.tris[g / 3][g % 3] = (int)r.vertex.size();
        if (!r.split[v]) apart.push_back(g / 3);
      }
      r.vertex.push_back(r.vertex[v]);
      r.copied.push_back(v);
    }
    fans[v] = fans[v] == none ? one : many;
  }
  if (std::count(r.split.begin(), r.split.end(), 1))
    r.opposite = opposite_halfedges(r.tris, (int)r.vertex.size());
  report.copies = (int)r.vertex.size() - n;
  if (report.nonmanifold_vertices) return;
  report.nonmanifold_vertices = vertices;
  for (int t : apart) record(report, r.face[t], Fault::pinched);
}

void unite(Repair& r) {
  for (Tri& t : r.tris)
    for (int& v : t) v = base(r, v);
  r.vertex.resize(r.vertex.size() - r.copied.size());
  r.copied.clear();
}

void flip(Repair& r, int t) {
  std::swap(r.tris[t][1], r.tris[t][2]);
  std::swap(r.opposite[3 * t], r.opposite[3 * t + 2]);
  for (int h : {3 * t, 3 * t + 2})
    if (r.opposite[h] >= 0) r.opposite[r.opposite[h]] = h;
  r.flipped[t] ^= 1;
}

void drop(Repair& r, const std::vector<char>& gone) {
  std::vector<int> number(r.opposite.empty() ? 0 : gone.size(), -1);
  std::size_t n = 0;
  for (std::size_t t = 0; t < gone.size(); ++t) {
    if (gone[t]) continue;
    r.tris[n] = r.tris[t];
    r.face[n] = r.face[t];
    if (!r.flipped.empty()) r.flipped[n] = r.flipped[t];
    if (!r.opposite.empty()) {
      std::copy_n(r.opposite.begin() + 3 * t, 3, r.opposite.begin() + 3 * n);
      number[t] = (int)n;
    }
    ++n;
  }
  r.tris.resize(n);
  r.face.resize(n);
  if (!r.flipped.empty()) r.flipped.resize(n);
  if (r.opposite.empty()) return;
  r.opposite.resize(3 * n);
  for (int& o : r.opposite)
    if (o >= 0) o = number[o / 3] < 0 ? -1 : 3 * number[o / 3] + o % 3;
}

}  // namespace meshpipe
