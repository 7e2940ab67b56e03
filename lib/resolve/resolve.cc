// SPDX-License-Identifier: BSD-3-Clause
#include "lib/resolve/resolve.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "lib/core/bvh.h"
#include "lib/core/edges.h"
#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/take_rows.h"
#include "lib/core/weld.h"
#include "lib/resolve/arrange.h"
#include "lib/resolve/outer.h"
#include "lib/resolve/simplify.h"

namespace meshpipe {
namespace {

/// Arrangements until rounded points intersect nowhere; one or two suffice except where planes nearly
/// coincide.
constexpr int most_passes = 12;
/// Slivers are removed before the second pass up to this height, in spacings of doubles at the largest
/// coordinate, and `growth` times more before each later one.
constexpr double first_height = 8, growth = 8;

/// Flags the vertices of triangles that intersect.
std::vector<char> vertices_of(const PieceMesh& s, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<char> hit(s.points.size(), 0);
  for (const auto& [t, u] : pairs)
    for (int f : {t, u})
      for (int v : s.pieces.tris[f]) hit[v] = 1;
  return hit;
}

/// Throws NotAdmissible if a component intersects of which the outside is not determined.
void refuse_ambiguous(const Hull& hull, const Pieces& pieces, const PieceMesh& s,
                      const std::vector<std::pair<int, int>>& pairs) {
  int n = 0, first = -1;
  for (const auto& [t, u] : pairs)
    if (hull.ambiguous[hull.component[pieces.piece_of[t]]] && n++ == 0) first = t;
  if (n == 0) return;
  const Vec3 p = s.points[s.pieces.tris[first][0]];
  char place[96];
  std::snprintf(place, sizeof place, "(%.6g %.6g %.6g)", p.x, p.y, p.z);
  throw NotAdmissible(std::to_string(n) + " of " + std::to_string(pairs.size()) +
                      " intersections, the first near " + place +
                      ", are of components with borders that have no inside: fill their holes (mclean "
                      "--fill-holes N), or run mwrap");
}

/// One arrangement, of which the pieces that `options` ask for are kept.
void pass(PieceMesh& s, const std::vector<std::pair<int, int>>& pairs, const ResolveOptions& options,
          ResolveReport& report) {
  ExactPoints points(s.points, vertices_of(s, pairs));
  Pieces pieces = arrange(s.pieces.tris, s.pieces.weight, pairs, points);
  const std::vector<int> before = s.pieces.origin;
  if (options.keep == ResolveOptions::outer) {
    const Hull hull = outer_hull(pieces, s.pieces.tris, s.pieces.weight, points);
    if (report.passes == 1) {
      report.open = (int)std::count(hull.open.begin(), hull.open.end(), 1);
      report.subtracted = hull.subtracted;
      refuse_ambiguous(hull, pieces, s, pairs);
    }
    int n = 0;
    for (std::size_t t = 0; t < pieces.tris.size(); ++t) {
      Tri tri = pieces.tris[t];
      if (hull.keep[t] == 0) {
        ++report.dropped;
        report.dropped_area +=
            0.5 * norm(area_vector(points.near(tri[0]), points.near(tri[1]), points.near(tri[2])));
        continue;
      }
      if (hull.keep[t] < 0) std::swap(tri[1], tri[2]), ++report.reversed;
      pieces.tris[n] = tri;
      pieces.origin[n] = pieces.origin[t];
      pieces.weight[n++] = 1;
    }
    pieces.tris.resize(n);
    pieces.origin.resize(n);
    pieces.weight.resize(n);
  }
  for (int& t : pieces.origin) t = before[t];
  s.points.resize(points.size());
  for (int p = 0; p < points.size(); ++p) s.points[p] = points.near(p);
  s.pieces = std::move(pieces);
}

/// The places of the result's vertices on the input.
std::vector<Place> origins(const PieceMesh& s, const Surface& input) {
  std::vector<Place> of(s.points.size());
  for (std::size_t t = 0; t < s.pieces.tris.size(); ++t)
    for (int v : s.pieces.tris[t])
      if (of[v].face < 0) of[v] = closest_place(input, s.pieces.origin[t], s.points[v]);
  return of;
}

void interpolate(Table& table, const std::vector<Place>& of, const Surface& input) {
  for (Column& c : table.columns)
    std::visit(
        [&]<class T>(std::vector<T>& old) {
          std::vector<T> values;
          for (const Place& p : of) {
            const bool at_vertex = std::max({p.b0, p.b1, p.b2}) == 1;
            if (std::is_same_v<T, double> && !at_vertex)
              values.push_back((T)value_at(p, old, input.tris));
            else
              values.push_back(old[input.tris[p.face][nearest_corner(p)]]);
          }
          old = std::move(values);
        },
        c.data);
  table.rows = of.size();
}

void take_over(const PieceMesh& s, Surface& surface, ResolveReport& report) {
  const std::vector<Place> of = origins(s, surface);
  PointNumbers places(surface.points.size());
  std::vector<int> numbers(std::max(surface.points.size(), s.points.size()));
  places.add(surface.points.data(), (int)surface.points.size(), numbers.data());
  const std::size_t before = places.points.size();
  places.add(s.points.data(), (int)s.points.size(), numbers.data());
  report.new_vertices = (int)(places.points.size() - before);
  interpolate(surface.vertex, of, surface);
  take_rows(surface.face, s.pieces.origin);
  surface.face.erase("model");
  surface.points = s.points;
  surface.tris = s.pieces.tris;
}

bool is_closed(const Mesh& mesh) {
  bool closed = true;
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    int sum = 0;
    for (EdgeUse e : uses) sum += origin(mesh.tris, half_edge(e)) < target(mesh.tris, half_edge(e)) ? 1 : -1;
    closed = closed && sum == 0;
  });
  return closed;
}

}  // namespace

ResolveReport resolve(Surface& surface, const ResolveOptions& options) {
  expect_measurable(surface);
  ResolveReport report;
  PieceMesh s;
  s.points = surface.points;
  s.pieces.tris = surface.tris;
  s.pieces.weight.assign(surface.tris.size(), 1);
  for (int t = 0; t < (int)surface.tris.size(); ++t) s.pieces.origin.push_back(t);
  normalize(s);
  double largest = 0;
  for (const Vec3& p : s.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const double spacing = std::ldexp(std::numeric_limits<double>::epsilon(), std::ilogb(largest));
  for (;;) {
    auto pairs = self_intersections({s.points, s.pieces.tris});
    report.left = (int)pairs.size();
    if (report.passes == 0) {
      report.pairs = report.left;
      std::vector<char> hit(s.pieces.tris.size(), 0);
      for (const auto& [t, u] : pairs) hit[t] = hit[u] = 1;
      report.triangles = (int)std::count(hit.begin(), hit.end(), 1);
    }
    if (report.passes == 0 && pairs.empty() && options.keep == ResolveOptions::all) break;
    if ((report.passes > 0 && pairs.empty()) || report.passes == most_passes) break;
    if (report.passes > 0) {
      report.removed = spacing * first_height * std::pow(growth, report.passes - 1);
      remove_slivers(s, vertices_of(s, pairs), report.removed);
      pairs = self_intersections({s.points, s.pieces.tris});
    }
    ++report.passes;
    pass(s, pairs, options, report);
    normalize(s);
  }
  report.nothing = report.pairs == 0 && report.reversed == 0 && s.pieces.tris.size() == surface.tris.size();
  if (!report.nothing) take_over(s, surface, report);
  report.closed = is_closed(surface);
  return report;
}

}  // namespace meshpipe
