// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"
#include "lib/core/error.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/lift/lift.h"

namespace meshpipe {
namespace {

enum On : char { inside, on_model, on_border };

std::vector<std::uint8_t> model_bits(const Surface& s) {
  return s.face.has("model") ? s.face.get<std::uint8_t>("model") : std::vector<std::uint8_t>(s.tris.size());
}

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

double mean_edge(const Mesh& mesh) {
  double sum = 0;
  for (const Tri& t : mesh.tris)
    for (int i = 0; i < 3; ++i) sum += norm(mesh.points[t[(i + 1) % 3]] - mesh.points[t[i]]);
  return sum / (3 * (double)mesh.tris.size());
}

}  // namespace

LiftedMesh place_on(const Surface& mesh, const Surface& reference) {
  LiftedMesh r;
  r.tris = mesh.tris;
  r.model = model_bits(mesh);
  const int n = (int)mesh.points.size();
  const std::vector<int> opposite = opposite_halfedges(mesh.tris, n),
                         ref_opposite = opposite_halfedges(reference);
  const Connectivity below{reference, ref_opposite, model_of(reference)};
  std::vector<char> on(n, inside);
  for (int h = 0; h < (int)opposite.size(); ++h) {
    const On kind = opposite[h] < 0 ? on_border : r.model[h / 3] >> (h % 3) & 1 ? on_model : inside;
    for (int v : {origin(mesh.tris, h), target(mesh.tris, h)}) on[v] = std::max<char>(on[v], kind);
  }

  r.points.resize(n), r.place.resize(n);
  std::vector<int> halfedges[3];
  for (On kind : {inside, on_model, on_border}) {
    const Mesh edges = kind == inside ? Mesh{} : edges_of(below, kind, halfedges[kind]);
    const bool none = edges.tris.empty();  // no such edges: take the nearest point of the surface
    const Bvh tree(none ? (const Mesh&)reference : edges);
#pragma omp parallel for schedule(static) if (n > 10000)
    for (int v = 0; v < n; ++v) {
      if (on[v] != kind) continue;
      const Bvh::Hit hit = tree.nearest(mesh.points[v]);
      r.place[v] =
          none ? hit.place : place_on_edge(halfedges[kind][hit.place.face], hit.place.b0, 1 - hit.place.b0);
    }
  }
  const double edge = mean_edge(mesh);
  int far = 0;
  for (int v = 0; v < n; ++v) {
    const Place& p = r.place[v];
    r.points[v] = value_at(p, reference.points, reference.tris);
    far += norm(r.points[v] - mesh.points[v]) > edge;
    if (!reference.vertex.has("size")) continue;
    r.size.push_back(value_at(p, reference.vertex.get<double>("size"), reference.tris));
  }
  if (2 * far > n)
    throw NotAdmissible("the mesh is not one of the reference: " + std::to_string(far) + " of " +
                        std::to_string(n) + " vertices are farther from it than a mean edge, " + shown(edge));
  if (r.size.empty())
    r.size.assign(n, std::sqrt(4 / std::sqrt(3.0) * total_area(reference) / (double)mesh.tris.size()));
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

}  // namespace meshpipe
