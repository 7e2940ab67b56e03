// SPDX-License-Identifier: BSD-3-Clause
// A mesh together with its connectivity: what most algorithms on surfaces take.
#pragma once
#include "lib/core/fan.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns the length of half-edge h.
inline double edge_length(const Mesh& mesh, int h) {
  return norm(mesh.points[target(mesh.tris, h)] - mesh.points[origin(mesh.tris, h)]);
}
/// Returns the normal of triangle t with twice its area as length.
inline Vec3 area_vector(const Mesh& mesh, int t) {
  const Tri& v = mesh.tris[t];
  return area_vector(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]);
}
inline double triangle_area(const Mesh& mesh, int t) { return 0.5 * norm(area_vector(mesh, t)); }
/// Returns the mean of the corners of triangle t.
inline Vec3 centroid(const Mesh& mesh, int t) {
  const Tri& v = mesh.tris[t];
  return (1.0 / 3) * (mesh.points[v[0]] + mesh.points[v[1]] + mesh.points[v[2]]);
}

/// Returns six times the volume of the tetrahedron of triangle t and p, positive if p is behind t.
inline double volume6(const Mesh& mesh, int t, Vec3 p) {
  const Tri& v = mesh.tris[t];
  return dot(mesh.points[v[0]] - p, cross(mesh.points[v[1]] - p, mesh.points[v[2]] - p));
}

inline const std::vector<std::uint8_t> no_model;

/// A view of a mesh, its opposite half-edges, and the bits of its model edges; owns none of them.
/// Requires: they outlive the view. It follows their changes, also of size.
struct Connectivity {
  const Mesh& mesh;
  const std::vector<int>& opposite;                   ///< lib/core/topology.h
  const std::vector<std::uint8_t>& model = no_model;  ///< face column `model`; empty: no model edges

  int n_tris() const { return (int)mesh.tris.size(); }
  int n_half_edges() const { return (int)opposite.size(); }
  int n_vertices() const { return (int)mesh.points.size(); }

  int from(int h) const { return origin(mesh.tris, h); }
  int to(int h) const { return target(mesh.tris, h); }
  int apex(int h) const { return origin(mesh.tris, prev(h)); }
  Vec3 point(int v) const { return mesh.points[v]; }

  bool is_border(int h) const { return opposite[h] < 0; }
  /// Returns whether h is marked as a model edge in its own triangle.
  bool is_model(int h) const { return !model.empty() && (model[h / 3] >> (h % 3) & 1); }
  double length(int h) const { return edge_length(mesh, h); }
  /// Returns the normal of triangle t with twice its area as length.
  Vec3 area_vector(int t) const { return meshpipe::area_vector(mesh, t); }

  /// Calls visit(g) for the half-edges around the origin of h, as for_each_spoke in lib/core/fan.h.
  template <class Visit>
  bool for_each_spoke(int h, Visit visit) const {
    return meshpipe::for_each_spoke(opposite, h, visit);
  }
};

/// Returns the face column `model` of a surface; an empty column if it has none.
const std::vector<std::uint8_t>& model_of(const Surface& surface);

/// A surface that is cut, and its opposite half-edges, which follow; owns neither.
struct CutSurface {
  Surface& surface;
  std::vector<int>& opposite;
  Connectivity connectivity() const { return {surface, opposite, model_of(surface)}; }
};

/// A part of a surface with connectivity of its own; `vertex` and `face` are the numbers in the whole.
struct ConnectedPart : SubMesh {
  std::vector<int> opposite;
  std::vector<std::uint8_t> model;
  Connectivity connectivity() const { return {*this, opposite, model}; }
};

/// Copies the triangles with label `l` (`label`: per triangle) to a part; edges to others become border.
ConnectedPart select_part(const Connectivity& whole, std::vector<int> label, int l);

}  // namespace meshpipe
