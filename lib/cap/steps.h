// SPDX-License-Identifier: BSD-3-Clause
// The steps of treat_ends, and what they share.
#pragma once
#include <optional>

#include "lib/cap/cap.h"
#include "lib/core/connectivity.h"

namespace meshpipe {

/// Radii below the lowest vertex of a rim at which an end is cut.
constexpr double below_rim = 0.1;

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

/// Computes all members of an end that follow from its rims.
void measure(const Mesh& mesh, End& end);
/// Makes an end of a rim, and measures it.
End end_of(const Mesh& mesh, std::vector<int> rim);

/// Returns the vertices of border loops, each counterclockwise as seen from outside.
std::vector<std::vector<int>> rims_of(const Connectivity& c);

/// Throws NotAdmissible with the title of end i and the reason.
[[noreturn]] void refuse(const std::vector<End>& ends, int i, const std::string& why);
/// Throws NotAdmissible if an end has a reason (`why`, per end; "": none), with that of the first and the
/// advice. With flags of the ends that are left out already (`kept`, may be empty), the advice names these
/// and all that have a reason, for --except.
void refuse_all(const std::vector<End>& ends, const std::vector<std::string>& why, const std::string& advice,
                const std::vector<char>* kept = nullptr);

/// Returns the middle of an edge of the end's rims that crosses another one, seen along its normal; or none.
std::optional<Vec3> crossing_of(const Mesh& mesh, const End& end);
/// Returns that as a clause, "its rim crosses itself, seen along its normal, near x y z"; or "".
std::string crossing_at(const Mesh& mesh, const End& end);

/// A flagged triangle that intersects another one, and a point near.
struct Collision {
  int triangle, other;
  Vec3 place;
};
/// Returns the pairs of intersecting triangles, with area, of which at least one is flagged; sorted.
std::vector<Collision> collisions(const Mesh& mesh, const std::vector<char>& flagged);

/// Returns the same for the triangles that were made for an end: owner[t] >= 0.
std::vector<Collision> collisions_of_new(const Mesh& mesh, const std::vector<int>& owner);

/// Splits the edges inside the surface that join two vertices of rims, and moves their middles towards the
/// wall: what lies behind such an edge would become flat in a plane rim, and a cap would touch it.
void split_chords(Surface& surface, const std::vector<End>& ends);

/// Returns per end the plane at a length from the rim along the vessel's axis, perpendicular to the wall
/// there; none where the length is 0, or the vessel is shorter: then why[i] is set.
std::vector<std::optional<Plane>> planes_within(const Mesh& mesh, const std::vector<End>& ends,
                                                const std::vector<double>& length,
                                                std::vector<std::string>& why);
/// Cuts off, per end with a plane, what is connected with its rims and lies above the plane. Numbers of
/// vertices change, rims follow. Returns per end why it cannot be cut, as where a branch would go too: then
/// nothing is changed; all are empty if it was done.
std::vector<std::string> cut_ends(Surface& surface, std::vector<End>& ends,
                                  const std::vector<std::optional<Plane>>& planes);

/// Cuts all ends that can be cut. For the others `why` is set and their planes are removed.
void cut_possible_ends(Surface& surface, std::vector<End>& ends, std::vector<std::optional<Plane>>& planes,
                       std::vector<std::string>& why);

/// Moves rims into planes, the movement fading out along the wall, such that no triangle folds or newly
/// intersects. Ends without a plane stay. Returns per end how far a vertex moved; -1 if impossible: nothing
/// moved.
std::vector<double> flatten_ends(Mesh& mesh, const std::vector<End>& ends,
                                 const std::vector<std::optional<Plane>>& planes);

/// What was added to a mesh: for each new vertex, whose columns it copies.
struct Growth {
  std::size_t first = 0;         ///< vertices before
  std::vector<int> vertex_like;  ///< per new vertex: the earlier one whose data it copies
  void add_like(int v) { vertex_like.push_back((std::size_t)v < first ? v : vertex_like[v - first]); }
};
/// Raises the rims of an end to a plane above them, by walls on which their notches are smoothed: a stub,
/// such as is left of a branch. The borders of the stub become the rims.
void raise_end(Mesh& mesh, End& end, Growth& growth);
/// Calls raise_end for the flagged ends, along their normals or a little off. Returns per end what is in the
/// way, if it was left alone. owner[t] becomes the end for which triangle t was made.
std::vector<std::string> raise_ends(Mesh& mesh, std::vector<End>& ends, const std::vector<char>& flagged,
                                    Growth& growth, std::vector<int>& owner);
/// Extends the rims of an end along its normal by tubes of this length that become circular; the circles
/// become the rims. Returns the number of triangles.
int extend_end(Mesh& mesh, End& end, double length, Growth& growth);
/// Closes an end by triangles over its projected rims; returns their number. Requires: no crossing_of.
int projected_cap(Mesh& mesh, const End& end, Growth& growth);
/// Returns whether fair_cap applies: whether the end has one rim, of at most 600 vertices.
bool fits_membrane(const End& end);
/// Closes an end by a membrane that bulges outward by about `bulge` radii, from the triangulation of least
/// area. Requires: fits_membrane(end). Returns the number of triangles.
int fair_cap(Mesh& mesh, const End& end, double bulge, Growth& growth);

}  // namespace meshpipe
