// SPDX-License-Identifier: BSD-3-Clause
// Connectivity of a triangle mesh: neighbors, components, boundary loops, genus (the paper's eq. 2).
#pragma once
#include <vector>

#include "lib/core/connectivity.h"
#include "lib/core/lists.h"

namespace meshpipe {

/// Computes the opposite half-edges (lib/core/mesh.h) of an oriented manifold. Linear, without hashing.
/// Throws: NotAdmissible naming the edge if it has more than two triangles, or two that run along it the same
/// way, or the triangle if it has a vertex twice.
std::vector<int> opposite_halfedges(const std::vector<Tri>& tris, int n_vertices);
inline std::vector<int> opposite_halfedges(const Mesh& mesh) {
  return opposite_halfedges(mesh.tris, (int)mesh.points.size());
}

/// Returns for each vertex the other two vertices of each of its triangles, one pair after the other. Linear.
inline Lists neighbors_of(const Mesh& mesh) {
  return lists_of((int)mesh.points.size(), [&](auto use) {
    for (const auto& [a, b, c] : mesh.tris) use(a, b), use(a, c), use(b, c), use(b, a), use(c, a), use(c, b);
  });
}

/// Returns the opposite half-edges of the parts into which split_by_label has split a mesh by these labels.
std::vector<std::vector<int>> opposite_of_parts(const std::vector<SubMesh>& parts, const Connectivity& whole,
                                                const std::vector<int>& label);

/// Sets component[t] to the number of the edge-connected component of triangle t, in the order of their first
/// triangles; returns the number of components.
int components(const std::vector<int>& opposite, std::vector<int>& component);

/// Returns the border loops as lists of half-edges in order, each with its triangle on the left; loops come
/// by their smallest half-edge, with which they start. Requires: no pinched vertices on the border.
std::vector<std::vector<int>> boundary_loops(const std::vector<int>& opposite);

/// Returns the length of a loop of half-edges.
inline double loop_length(const Mesh& mesh, const std::vector<int>& loop) {
  double length = 0;
  for (int h : loop) length += edge_length(mesh, h);
  return length;
}

/// Returns the index of the longest loop, the first of equals. Requires: there is one.
inline std::size_t longest_loop(const Mesh& mesh, const std::vector<std::vector<int>>& loops) {
  std::size_t longest = 0;
  double most = loop_length(mesh, loops[0]);
  for (std::size_t l = 1; l < loops.size(); ++l)
    if (const double length = loop_length(mesh, loops[l]); length > most) most = length, longest = l;
  return longest;
}

/// Returns a half-edge that leaves the vertex for each fan of triangles at a vertex except its first.
std::vector<int> further_fans(const std::vector<Tri>& tris, const std::vector<int>& opposite, int n_vertices);
/// Returns the first vertex whose triangles do not form a single fan, or -1.
int find_pinched_vertex(const std::vector<Tri>& tris, const std::vector<int>& opposite, int n_vertices);
inline int find_pinched_vertex(const Connectivity& c) {
  return find_pinched_vertex(c.mesh.tris, c.opposite, c.n_vertices());
}

/// What the table of mtopo holds for a component or a part.
struct Topology {
  int vertices = 0, edges = 0, faces = 0;
  int components = 0;
  int genus = 0;  ///< eq. (2) summed over the components: (2 C - chi - N_B) / 2
  int loops = 0;  ///< N_B
  double area = 0;
  double longest_loop = 0;          ///< L
  std::vector<double> loop_length;  ///< in the order of boundary_loops
  double eta_cyl = 0;               ///< pi A / L^2; 0 if closed
  double eta_box = 0;  ///< longest side of the part's box over that of its longest loop (principal axes)
  double eta_geo = 0;  ///< H / D, H the largest edge-path distance from the longest loop, D = L / pi
};

/// Measures topology and aspect ratios of a mesh.
/// Throws: as opposite_halfedges; NotAdmissible naming a pinched vertex.
Topology topology_of(const Mesh& mesh);

/// Measures every part of a mesh, in parallel. `part`: per triangle, 0..n-1, or another label where there is
/// none. The row of a part without triangles is zero. Throws: as topology_of, naming the part.
std::vector<Topology> topology_of_parts(const Mesh& mesh, const std::vector<int>& part, int n);
/// Measures the same where the opposite half-edges of the mesh are known.
std::vector<Topology> topology_of_parts(const Connectivity& c, const std::vector<int>& part, int n);
/// Measures the components 0..n-1 of a mesh, as `components` has numbered them.
std::vector<Topology> topology_of_components(const Connectivity& c, const std::vector<int>& component, int n);

/// Returns whether a part satisfies the paper's conditions (5): one component, genus 0, at least one loop,
/// eta_geo below the limit.
bool admissible(const Topology& t, double max_aspect = 4);

/// Returns the number of parts that face column `part` names. Throws: NotAdmissible naming the triangle or
/// the part if they are not 0..n-1, each with a triangle.
int count_parts(const Surface& surface);

}  // namespace meshpipe
