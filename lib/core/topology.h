// SPDX-License-Identifier: BSD-3-Clause
// Connectivity of a triangle mesh: neighbors, components, boundary loops, genus (the paper's eq. 2).
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// opposite[3*t+i] as in lib/core/mesh.h, for an oriented manifold; linear (a counting sort by the smaller
/// vertex), no hashing. Throws NotAdmissible naming the edge if it has more than two triangles, or two that
/// disagree on direction, and naming the triangle if it has a repeated vertex.
std::vector<int> opposite_halfedges(const std::vector<Tri>& tris, int n_vertices);
inline std::vector<int> opposite_halfedges(const Mesh& mesh) {
  return opposite_halfedges(mesh.tris, (int)mesh.points.size());
}

/// The same for the sub-meshes that split_by_label has made of a mesh by these labels, from those of the
/// whole.
std::vector<std::vector<int>> opposite_of_parts(const std::vector<SubMesh>& parts, const Connectivity& whole,
                                                const std::vector<int>& label);

/// Returns the number of edge-connected components; component[t] in 0..n-1, numbered by their first triangle.
int components(const std::vector<int>& opposite, std::vector<int>& component);

/// Returns the border loops as lists of half-edges, each with its triangle on the left, in order; the loop
/// with the smallest half-edge first. Requires: no pinched vertices on the border (walks around the vertex
/// star).
std::vector<std::vector<int>> boundary_loops(const std::vector<int>& opposite);

/// Returns a half-edge that leaves the vertex in each fan of its triangles but the first.
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

/// Topology and aspect ratios of a mesh (one part: use split_by_label first).
/// Throws like opposite_halfedges; a pinched vertex is NotAdmissible too.
Topology topology_of(const Mesh& mesh);

/// The same for every part of a surface: part[t] in 0..n-1, or another label where there is none. Parallel
/// over the parts; rows of parts without triangles are empty.
std::vector<Topology> topology_of_parts(const Mesh& mesh, const std::vector<int>& part, int n);
/// The same where the mesh's neighbors are known.
std::vector<Topology> topology_of_parts(const Connectivity& c, const std::vector<int>& part, int n);
/// The same for the components, as `components` has numbered them; `opposite` is the mesh's.
std::vector<Topology> topology_of_components(const Connectivity& c, const std::vector<int>& component, int n);

/// The paper's conditions (5): genus 0, at least one loop, eta_geo below the limit, one component.
bool admissible(const Topology& t, double max_aspect = 4);

/// The number of parts that face column `part` names. Throws NotAdmissible naming the triangle or the part if
/// they are not 0..n-1, each with a triangle.
int count_parts(const Surface& surface);

}  // namespace meshpipe
