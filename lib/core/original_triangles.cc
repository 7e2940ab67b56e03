// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/original_triangles.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "lib/core/chord.h"
#include "lib/core/intersect.h"
#include "lib/core/junctions.h"
#include "lib/core/lists.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// The corners of the largest triangle of some points, if it covers all the pieces.
bool hull_of_pieces(const Mesh& mesh, std::span<const int> pieces, Tri& corners) {
  std::vector<int> v;
  Vec3 whole{};
  for (int t : pieces) {
    v.insert(v.end(), mesh.tris[t].begin(), mesh.tris[t].end());
    whole = whole + area_vector(mesh, t);
  }
  sort_unique(v);
  if (v.size() > 64) {
    // the farthest point of a triangle from any other is a corner, and so is the farthest from a side
    auto farthest = [&](auto distance) {
      return *std::max_element(v.begin(), v.end(), [&](int i, int j) { return distance(i) < distance(j); });
    };
    auto from = [&](int a) { return farthest([&](int i) { return norm(mesh.points[i] - mesh.points[a]); }); };
    auto area = [&](int a, int b, int c) {
      return dot(area_vector(mesh.points[a], mesh.points[b], mesh.points[c]), whole);
    };
    const int a = from(v[0]), b = from(a), c = farthest([&](int i) { return std::abs(area(a, b, i)); });
    v = {a, b, c};
  }
  double best = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    for (std::size_t j = i + 1; j < v.size(); ++j)
      for (std::size_t k = j + 1; k < v.size(); ++k) {
        const double a = dot(area_vector(mesh.points[v[i]], mesh.points[v[j]], mesh.points[v[k]]), whole);
        if (std::abs(a) <= best) continue;
        best = std::abs(a);
        corners = a > 0 ? Tri{v[i], v[j], v[k]} : Tri{v[i], v[k], v[j]};
      }
  return best > 0 && std::abs(best - dot(whole, whole)) <= 1e-6 * dot(whole, whole);
}

/// Returns the triangles in the order of their origins: by counting, unless there are none, or a damaged
/// stream has other numbers than a surface of about this size.
std::vector<int> by_origin(const std::vector<int>& origin) {
  const std::size_t n = origin.size();
  if (n == 0) return {};
  const auto [least, most] = std::minmax_element(origin.begin(), origin.end());
  if (*least < 0 || (std::size_t)*most > 1000 + 100 * n) {
    std::vector<int> order = identity(n);
    std::stable_sort(order.begin(), order.end(), [&](int s, int t) { return origin[s] < origin[t]; });
    return order;
  }
  return lists_by(*most + 1, origin).row;
}

}  // namespace

Mesh recover_triangles(const Mesh& mesh, const std::vector<int>& origin, std::vector<int>* whole_of) {
  const int n = (int)mesh.tris.size();
  Mesh whole;
  whole.points = mesh.points;
  whole.tris.reserve(n);
  const std::vector<int> order = by_origin(origin);
  if (whole_of) whole_of->resize(n);
  for (int first = 0, last; first < n; first = last) {
    for (last = first + 1; last < n && origin[order[last]] == origin[order[first]];) ++last;
    Tri corners;
    const bool one = last - first > 1 && origin[order[first]] >= 0 &&
                     hull_of_pieces(mesh, std::span(order).subspan(first, last - first), corners);
    if (one) whole.tris.push_back(corners);
    for (int i = first; i < last; ++i) {
      if (!one) whole.tris.push_back(mesh.tris[order[i]]);
      if (whole_of) (*whole_of)[order[i]] = (int)whole.tris.size() - 1;
    }
  }
  return whole;
}

Mesh original_mesh(const Surface& reference) {
  return reference.face.has("origin") ? recover_triangles(reference, reference.face.get<int>("origin"))
                                      : Mesh(reference);
}

Mesh reference_contacts(const Surface& reference, bool sheets_meet, std::span<const Box> near) {
  Mesh joined = original_mesh(reference);
  if (sheets_meet) join_borders(joined);
  const std::vector<int> opposite = opposite_halfedges(reference);
  const auto chords = chord_pairs({reference, opposite, model_of(reference)});
  constexpr double rounding = 1e-6;  // of the diagonal: single-precision coordinates, with a margin
  const double close = rounding * diagonal(joined);
  if (!near.empty()) {
    std::vector<Tri> kept;
    for (int t = 0; t < (int)joined.tris.size(); ++t) {
      const Box box = box_of(joined, t),
                around{box.lo - Vec3{close, close, close}, box.hi + Vec3{close, close, close}};
      if (std::any_of(near.begin(), near.end(), [&](const Box& b) { return overlap(b, around); }))
        kept.push_back(joined.tris[t]);
    }
    joined.tris = std::move(kept);
  }
  Mesh found = contacts(joined, self_intersections(joined));
  found = coincidences(joined, close, std::move(found));
  return contacts(reference, chords, std::move(found));
}

}  // namespace meshpipe
