// SPDX-License-Identifier: BSD-3-Clause
// The mesh while it is optimized, as plain columns, and the reference it lies on; for lib/relax/ only.
#pragma once
#include <algorithm>
#include <cmath>

#include "lib/core/edit_mesh.h"
#include "lib/core/lists.h"
#include "lib/core/surface_walk.h"
#include "lib/relax/relax.h"
#include "lib/relax/rules.h"

namespace meshpipe {

/// Returns the shape energy of a triangle: the square of the inverse mean ratio (l1^2 + l2^2 + l3^2) / (4
/// sqrt(3) A) (Knupp 2001). 1 for the equilateral, infinite for the degenerate; squared so that the worst
/// count most.
inline double shape_energy(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = area_vector(a, b, c);
  const double n2 = dot(n, n), squares = dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c);
  return n2 > 0 ? squares * squares / (12 * n2) : 1e30;
}

/// Returns the cosine of the normal deviation of triangle p, q, r: of the angle between its normal and
/// `reference`, the sum of the reference normals at its corners. 1 where that is zero, as when all corners
/// are on model edges.
inline double normal_cosine(Vec3 p, Vec3 q, Vec3 r, Vec3 reference) {
  const Vec3 n = area_vector(p, q, r);
  const double l2 = dot(n, n) * dot(reference, reference);
  return l2 > 0 ? dot(n, reference) / std::sqrt(l2) : 1;
}

/// Returns whether a change folds a triangle, from the least normal_cosine before and after it.
inline bool folds(double before, double after) {
  return after < std::min(before, rules::least_cosine) - rules::same_cosine;
}

/// The reference surface, ready to be walked on. Keeps a reference to it.
struct Reference {
  explicit Reference(const Surface& reference);
  /// Returns the smooth unit normal at a place.
  Vec3 normal(const Place& p) const;
  /// Returns the size at a place. Requires: `sizes`.
  double size(const Place& p) const;
  int component_of(const Place& p) const { return component.empty() ? 0 : component[p.face]; }

  const Surface& surface;
  const std::vector<double>* sizes;  ///< null if the surface has none
  const std::vector<int>* patches;   ///< the same
  const SurfaceWalk walk;
  std::vector<Vec3> normals;  ///< at the vertices, not of unit length
  /// Per triangle; empty: all are one. What the mesh misses of a component is measured by the mesh on it, not
  /// by that of another in which it may lie. Tiles, and meshes of sheets that meet, have none.
  std::vector<int> component;
};

/// A change of connectivity: of the edge of half-edge h.
struct Edit {
  enum Kind { flip, split, collapse, slide, release, reach } kind;
  int h;
  int end = -1;     ///< the vertex that a collapse takes out, that slides, or that is no longer anchored
  double at = 0.5;  ///< where a split is tried, as in split_edge; how far a slide goes, see slide_end
  Place place{};    ///< that a vertex reaches, `end` or, if that is -1, a new one on the edge
};

/// Times at which vertices changed, by one clock: what has not changed is not tried again.
struct Clocks {
  std::vector<int> tried;    ///< when each vertex was last tried to move
  std::vector<int> changed;  ///< when it last moved or its neighbors changed
  std::vector<int> edited;   ///< when its neighbors changed
  int flipped = 0;           ///< when flip_to_shape last looked
  int now = 0;
};

/// What can move in parallel: vertices of different blocks, 2^b with the same higher bits of their numbers,
/// that have all neighbors in their own block.
struct Schedule {
  std::vector<char> span;  ///< per vertex, the least b for which its neighbors are in its block
  Lists order;             ///< vertices that may move, by the level of their span, while `listed`
  bool listed = false;
};

/// Columns that pass through: of vertices, and of triangles. A patch has none.
struct Labels {
  std::vector<int> kind, line;
  std::vector<int> patch, part;
};

/// What a tile of a mesh knows of all of it.
struct OfWhole {
  std::vector<int>
      rim_excess;           ///< of frozen vertices: see excess, less the valence in the tile; empty: no tile
  double mean_size = 0;     ///< see mean_size; 0: that of this mesh
  double share = 1;         ///< of the work that is shown
  bool keep_count = false;  ///< repair of shapes adds few triangles
};

/// A mesh on its reference, while it is optimized.
struct State {
  State(const Reference& on, EditMesh edited_mesh, std::vector<Vec3> at, std::vector<Place> places,
        std::vector<double> sizes);

  /// Returns the wanted edge length at v.
  double target(int v) const { return size[v] * refinement[v]; }
  /// Returns the length of an edge over the size at its ends.
  double length(int a, int b) const { return 2 * norm(points[b] - points[a]) / (target(a) + target(b)); }
  double length(int h) const { return length(mesh.from(h), mesh.to(h)); }
  double shape(int a, int b, int c) const { return shape_energy(points[a], points[b], points[c]); }
  double cosine(int a, int b, int c) const {
    return normal_cosine(points[a], points[b], points[c], normal[a] + normal[b] + normal[c]);
  }
  /// Returns the unit normal of triangle t.
  Vec3 face_normal(int t) const {
    const Tri& v = mesh.tris[t];
    return normalized(area_vector(points[v[0]], points[v[1]], points[v[2]]));
  }

  const Reference* reference;
  EditMesh mesh;
  std::vector<Vec3> points;
  std::vector<Place> place;        ///< on the reference
  std::vector<Vec3> normal;        ///< of the reference; zero on model edges, which have two
  std::vector<double> size;        ///< the size field
  std::vector<double> refinement;  ///< factor on it, below 1 where triangles intersected
  std::vector<Hold> hold;
  /// The next copy of each vertex, in a ring, where sheets meet; empty: none meet. Copies move together.
  std::vector<int> copy;
  Labels labels;
  Clocks clocks;
  Schedule schedule;
  RelaxCounts counts;
  bool keep_border = false;  ///< no new vertex on the border
  bool acute = false;  ///< are so few triangles bad that those at borders and anchors are to be acute, too?
  OfWhole whole;
  bool recording = false;
  std::vector<Edit> edits;  ///< while recording
};

/// Returns whether v has copies.
inline bool is_shared(const State& s, int v) { return !s.copy.empty() && s.copy[v] != v; }

/// Returns the component of the reference on which triangle t lies.
inline int component_of(const State& s, int t) {
  return s.reference->component_of(s.place[s.mesh.tris[t][0]]);
}

/// Calls f for v and its copies.
template <class F>
void for_copies(const State& s, int v, F&& f) {
  int w = v;
  do {
    f(w);
    if (s.copy.empty()) return;
    w = s.copy[w];
  } while (w != v);
}

/// Returns whether triangle p, q, r has the orientation of the reference at the place nearest to its
/// centroid, reached by a walk from `from`. Where the reference bends much within an edge, as at a spike, the
/// normals at the corners do not tell.
bool faces_reference(const State& s, const Place& from, Vec3 p, Vec3 q, Vec3 r);

/// Makes the state of a mesh to optimize, from which columns are moved. Arguments as in relax.
State start_state(LiftedMesh& mesh, const Reference& reference, const std::vector<int>& line_kind,
                  const std::vector<char>& corner, bool sheets_meet = false);
/// Throws NotAdmissible if a vertex that is not frozen has several fans: edits would tear them apart.
void expect_single_fans(const State& s);

/// Moves the mesh, numbered without gaps, to `mesh`. Returns the new row of each triangle, or -1.
std::vector<int> finish(State& s, LiftedMesh& mesh);

/// Returns the edge length if all triangles (of a tile: of the whole) were equilateral and equal.
double mean_size(const State& s);

/// Puts v at a place of the reference, whose point is p; the size becomes that of the place.
void put(State& s, int v, const Place& place, Vec3 p, Vec3 normal);

inline void mark_changed(State& s, int v) { s.clocks.changed[v] = ++s.clocks.now; }
/// Notes that the neighbors of v have changed: to be called for every such vertex.
void mark_edited(State& s, int v);

/// Returns the smaller half-edges of inside edges that are no model edges and longer than `limit` times the
/// size, the longest first; with `shorter`, of those that are shorter, the shortest first.
std::vector<int> edges_by_length(const State& s, double limit, bool shorter);

}  // namespace meshpipe
