// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"
#include "lib/core/error.h"
#include "lib/core/normals.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"
#include "lib/lift/lift.h"

namespace meshpipe {
namespace {

constexpr double much_farther = 3;  ///< times as far as the nearest point of all

enum On : char { inside, on_model, on_border };

/// Returns the border edges of a surface, or its model edges, as triangles without area; `halfedges[i]` is
/// the half-edge of triangle i.
Mesh edges_of(const Connectivity& s, On kind, std::vector<int>& halfedges) {
  Mesh edges{s.mesh.points, {}};
  for (int h = 0; h < s.n_half_edges(); ++h) {
    if (kind == on_border ? !s.is_border(h) : s.is_border(h) || !s.is_model(h)) continue;
    edges.tris.push_back({s.from(h), s.to(h), s.to(h)});
    halfedges.push_back(h);
  }
  return edges;
}

/// Returns the place of the reference nearest to each point: of its border or model edges for points that are
/// on_border or on_model, where there are any; else what `inside_place` returns for the tree of its
/// triangles.
template <class InsidePlace>
std::vector<Place> nearest_places(const std::vector<Vec3>& points, const std::vector<char>& on,
                                  const Surface& reference, const InsidePlace& inside_place) {
  const std::vector<int> opposite = opposite_halfedges(reference);
  const Connectivity below{reference, opposite, model_of(reference)};
  const int n = (int)points.size();
  std::vector<Place> places(n);
  std::vector<int> halfedges;
  for (On kind : {inside, on_model, on_border}) {
    if (std::find(on.begin(), on.end(), kind) == on.end()) continue;
    halfedges.clear();
    const Mesh edges = kind == inside ? Mesh{} : edges_of(below, kind, halfedges);
    const bool none = edges.tris.empty();
    const Bvh tree(none ? (const Mesh&)reference : edges);
#pragma omp parallel for schedule(static) if (n > 10000)
    for (int i = 0; i < n; ++i) {
      if (on[i] != kind) continue;
      if (none) {
        places[i] = inside_place(tree, i);
        continue;
      }
      const Place at = tree.nearest(points[i]).place;
      places[i] = place_on_edge(halfedges[at.face], at.b0, 1 - at.b0);
    }
  }
  return places;
}

/// Unit normals per triangle of a surface, with its tree: where the nearest point may be on the other side of
/// a thin sheet.
struct Sides {
  const Surface& surface;
  const std::vector<Vec3>& normal;
  const Bvh& tree;

  /// Returns the place nearest to p among triangles that face the way of n, as far as that is not much
  /// farther than the nearest of all, or within `reach`; else the nearest of all.
  Place nearest(Vec3 p, Vec3 n, double reach) const {
    const Bvh::Hit hit = tree.nearest(p);
    if (dot(normal[hit.place.face], n) > 0) return hit.place;
    Place best = hit.place;
    double least = much_farther * hit.distance + reach;
    const Vec3 r = least * Vec3{1, 1, 1};
    tree.overlapping({p - r, p + r}, [&](int t) {
      if (!(dot(normal[t], n) > 0)) return;
      const Place place = closest_place(surface, t, p);
      const double d = norm(value_at(place, surface.points, surface.tris) - p);
      if (d < least || (d == least && t < best.face)) best = place, least = d;
    });
    return best;
  }
};

/// Interpolates the vertex data that only the coarse surface has, at the nearest points.
void add_missing_columns(const Surface& coarse, const std::vector<Vec3>& coarse_normal, Surface& fine) {
  const std::vector<double>& size = coarse.vertex.get<double>("size");
  std::vector<Place> nearest;
  for (const Column& c : coarse.vertex.columns) {
    const auto* values = std::get_if<std::vector<double>>(&c.data);
    if (!values || fine.vertex.has(c.name)) continue;
    std::vector<double> to(fine.points.size(), values->front());
    if (std::adjacent_find(values->begin(), values->end(), std::not_equal_to<>()) != values->end()) {
      if (nearest.empty()) {
        nearest.resize(fine.points.size());
        const Bvh tree(coarse);
        const std::vector<Vec3> normal = vertex_normals(fine);
        const double reach = *std::min_element(size.begin(), size.end());
#pragma omp parallel for schedule(static)
        for (int v = 0; v < (int)nearest.size(); ++v)
          nearest[v] = Sides{coarse, coarse_normal, tree}.nearest(fine.points[v], normal[v], reach);
      }
      for (std::size_t v = 0; v < to.size(); ++v) to[v] = value_at(nearest[v], *values, coarse.tris);
    }
    fine.vertex.set(c.name, std::move(to));
  }
}

}  // namespace

LiftedMesh place_on(const Surface& mesh, const Surface& reference) {
  LiftedMesh r;
  r.tris = mesh.tris;
  r.model = model_of(mesh);
  r.model.resize(mesh.tris.size());
  const int n = (int)mesh.points.size();
  const std::vector<int> opposite = opposite_halfedges(mesh.tris, n);
  std::vector<char> on(n, inside);
  for (int h = 0; h < (int)opposite.size(); ++h) {
    const On kind = opposite[h] < 0 ? on_border : r.model[h / 3] >> (h % 3) & 1 ? on_model : inside;
    for (int v : {origin(mesh.tris, h), target(mesh.tris, h)}) on[v] = std::max<char>(on[v], kind);
  }
  r.place = nearest_places(mesh.points, on, reference,
                           [&](const Bvh& tree, int v) { return tree.nearest(mesh.points[v]).place; });
  const double edge = size_for_count(total_area(mesh), (double)mesh.tris.size());
  int far = 0;
  for (int v = 0; v < n; ++v) {
    const Place& p = r.place[v];
    r.points.push_back(value_at(p, reference.points, reference.tris));
    far += norm(r.points[v] - mesh.points[v]) > edge;
    if (!reference.vertex.has("size")) continue;
    r.size.push_back(value_at(p, reference.vertex.get<double>("size"), reference.tris));
  }
  if (2 * far > n)
    throw NotAdmissible("the mesh is not one of the reference: " + std::to_string(far) + " of " +
                        std::to_string(n) + " vertices are farther from it than a mean edge, " + shown(edge));
  if (r.size.empty()) r.size.assign(n, size_for_count(total_area(reference), (double)mesh.tris.size()));
  r.kind.resize(n);
  for (int v = 0; v < n; ++v) r.kind[v] = on[v] != inside;
  r.line.assign(n, -1);
  auto labels = [&](const char* name, int none) {
    return mesh.face.has(name) ? mesh.face.get<int>(name) : std::vector<int>(mesh.tris.size(), none);
  };
  r.patch = labels("patch", 1);
  r.part = labels("part", 0);
  return r;
}

void move_to_fine(LiftedMesh& mesh, Lines& lines, const Surface& coarse, Surface& fine) {
  constexpr On on_line[] = {on_border, on_model, inside};  // by LineKind
  const std::vector<Vec3> coarse_normal = face_normals(coarse), normal = face_normals(fine);
  // the points of lines after those of the mesh
  std::vector<Vec3> points = mesh.points;
  std::vector<char> on;
  for (int l : mesh.line) on.push_back(l < 0 ? inside : on_line[lines.lines[l].kind]);
  for (const Line& l : lines.lines)
    for (int i = l.first; i < l.first + l.count; ++i) {
      const LinePoint& p = lines.points[i];
      points.push_back(lerp(coarse.points[p.a], coarse.points[p.b], p.t));
      on.push_back(on_line[l.kind]);
    }
  const int n = (int)mesh.points.size();
  const std::vector<Place> places = nearest_places(points, on, fine, [&](const Bvh& tree, int i) {
    if (i >= n) return tree.nearest(points[i]).place;
    return Sides{fine, normal, tree}.nearest(points[i], coarse_normal[mesh.place[i].face], mesh.size[i]);
  });
  std::copy_n(places.begin(), n, mesh.place.begin());
  for (int v = 0; v < n; ++v) mesh.points[v] = value_at(mesh.place[v], fine.points, fine.tris);
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    const Place& p = places[n + i];
    const Tri& corner = fine.tris[p.face];
    const double weight[] = {p.b0, p.b1, p.b2};
    int a = nearest_corner(p), b = (a + 1) % 3;
    if (weight[(a + 2) % 3] > weight[b]) b = (a + 2) % 3;
    lines.points[i] = on[n + i] == inside || weight[a] == 1 ? LinePoint{corner[a], corner[a], 0}
                                                            : LinePoint{corner[a], corner[b], weight[b]};
  }
  add_missing_columns(coarse, coarse_normal, fine);
}

}  // namespace meshpipe
