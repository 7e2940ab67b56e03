// SPDX-License-Identifier: BSD-3-Clause
// The steps of treat_ends, and what they share.
#pragma once
#include <optional>

#include "lib/cap/cap.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

struct Plane {
  Vec3 point, normal;
  double height(Vec3 p) const { return dot(p - point, normal); }
};

/// Coordinates in a plane, such that (right, up, normal) is right-handed.
struct PlaneView {
  Vec3 right, up, origin;
  explicit PlaneView(const Plane& plane);
  Vec2 operator()(Vec3 p) const { return {dot(p - origin, right), dot(p - origin, up)}; }
};

/// Computes all of an end that follows from its rims.
void measure(const Mesh& mesh, End& end);
End end_of(const Mesh& mesh, std::vector<int> rim);

/// Returns the vertices of border loops, each counterclockwise as seen from outside.
std::vector<std::vector<int>> rims_of(const Connectivity& c);

[[noreturn]] void refuse(const std::vector<End>& ends, int i, const std::string& why);
/// Throws: NotAdmissible if an end has a reason, with that of the first. With flags of the ends that are left
/// out already (`kept`, may be empty) it names these and all that have a reason, for --except.
void refuse_all(const std::vector<End>& ends, const std::vector<std::string>& why, const std::string& advice,
                const std::vector<char>* kept = nullptr);

/// Returns the middle of an edge of an end's rims that crosses another one as seen along its normal; none if
/// they are simple as seen so.
std::optional<Vec3> crossing_of(const Mesh& mesh, const End& end);
/// Returns that as a clause, "its rim crosses itself, seen along its normal, near (x y z)"; else "".
std::string crossing_at(const Mesh& mesh, const End& end);

/// A triangle of interest that meets another one, and where.
struct Collision {
  int triangle, other;
  Vec3 place;
};
/// Returns the pairs of intersecting triangles at least one of which is flagged.
std::vector<Collision> collisions(const Mesh& mesh, const std::vector<char>& flagged);

/// The same for the triangles that were made for an end: owner >= 0.
std::vector<Collision> collisions_of_new(const Mesh& mesh, const std::vector<int>& owner);

/// Splits the edges inside the surface that join two vertices of rims, and moves their middles towards the
/// wall: what lies behind such an edge would be flat in a plane rim, and a cap would touch it or have it too.
void split_chords(Surface& surface, const std::vector<End>& ends);

/// Returns, per end, the plane at a length from the rim along the end's axis, normal to the wall there. No
/// plane where the length is 0, or the vessel is shorter: then `why` has the reason.
std::vector<std::optional<Plane>> planes_within(const Mesh& mesh, const std::vector<End>& ends,
                                                const std::vector<double>& length,
                                                std::vector<std::string>& why);
/// Cuts ends off: what is connected with their rims and lies above their planes. Ends without a plane stay.
/// Numbers of vertices change, rims follow. Returns per end why it cannot be cut, as where a branch would go
/// too; then nothing is changed. All are empty if it could.
std::vector<std::string> cut_ends(Surface& surface, std::vector<End>& ends,
                                  const std::vector<std::optional<Plane>>& planes);

/// The same for all ends that can be cut. For the others `why` says so, and their planes go.
void cut_possible_ends(Surface& surface, std::vector<End>& ends, std::vector<std::optional<Plane>>& planes,
                       std::vector<std::string>& why);

/// Moves rims into planes, and fades the movement out along the wall, such that no triangle folds or
/// intersects. Ends without a plane stay. Returns, per end, how far a vertex moved; -1 if that was impossible
/// and nothing moved.
std::vector<double> flatten_ends(Mesh& mesh, const std::vector<End>& ends,
                                 const std::vector<std::optional<Plane>>& planes);

/// What has been added to a mesh, for its columns.
struct Growth {
  std::size_t first = 0;         ///< vertices before
  std::vector<int> vertex_like;  ///< per new vertex: the earlier one whose data it copies
  void add_like(int v) { vertex_like.push_back((std::size_t)v < first ? v : vertex_like[v - first]); }
};
/// Raises the rims of an end to a plane above them, by walls on which their notches are smoothed: a stub,
/// such as is left of a branch. The rims are then the borders of that.
void raise_end(Mesh& mesh, End& end, Growth& growth);
/// The same for the ends flagged, along their normals or a little off. Returns what is in the way where that
/// is impossible. Triangles get `owner`, their end.
std::vector<std::string> raise_ends(Mesh& mesh, std::vector<End>& ends, const std::vector<char>& flagged,
                                    Growth& growth, std::vector<int>& owner);
/// Extends the rims of an end by tubes that become circular; the rims are then the circles. Returns the
/// number of triangles.
int extend_end(Mesh& mesh, End& end, double length, Growth& growth);
/// Closes an end by triangles that lie over its projected rims, which must be simple (crossing_of). Returns
/// their number.
int projected_cap(Mesh& mesh, const End& end, Growth& growth);
/// Returns whether fair_cap applies: to an end of one rim, of at most 600 vertices.
bool fits_membrane(const End& end);
/// Closes such an end by a membrane that bulges outward by about `bulge` radii, of the connectivity of the
/// triangulation of least area. Returns the number of triangles.
int fair_cap(Mesh& mesh, const End& end, double bulge, Growth& growth);

}  // namespace meshpipe
