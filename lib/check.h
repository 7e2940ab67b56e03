// SPDX-License-Identifier: BSD-3-Clause
// A mesh judged by itself: connectivity, orientation, quality.
#pragma once
#include <span>

#include "lib/mesh.h"

namespace meshpipe {

/// What is known of any triangles, sound or not; never throws. Of each kind of fault, a triangle for every
/// case, in no more order than that the same mesh gives the same list.
struct Connectivity {
  int vertices = 0, edges = 0, faces = 0;  ///< vertices that are used
  std::vector<int> degenerate;             ///< triangles with a repeated vertex
  std::vector<int> nonmanifold;            ///< edges of more than two triangles
  std::vector<int> turned;                 ///< edges whose two triangles disagree on orientation
  std::vector<int> pinched;                ///< vertices whose triangles form more than one fan
  bool sound() const {
    return degenerate.empty() && nonmanifold.empty() && turned.empty() && pinched.empty();
  }
  /// Half-edges as in lib/mesh.h; -1 also along edges that are not manifold and oriented.
  std::vector<int> opposite;
  int components = 0, genus = 0, loops = 0;  ///< of a sound mesh
  int loop = -1;                             ///< a half-edge of the shortest loop, of a sound mesh
  int small_component = -1;                  ///< a triangle of the smallest component, of a sound mesh
};
Connectivity connectivity_of(const Mesh& mesh);

struct Quality {
  double kappa_min = 0, kappa_p01 = 0, kappa_mean = 0;
  int worst = -1;                                           ///< the triangle with kappa_min
  double min_angle = 0, mean_min_angle = 0, max_angle = 0;  ///< degrees
  /// Edge lengths in units of the size field (its mean over the edge), or of the mean edge.
  double edge_min = 0, edge_mean = 0, edge_max = 0, edge_deviation = 0;
  double valence567 = 0;             ///< share of the inner vertices with 5, 6 or 7 neighbours
  std::vector<int> angle_histogram;  ///< smallest angles, 60 bins over [0, 60] degrees
  std::vector<float> kappas;         ///< of every triangle
};
/// `opposite` as Connectivity has it. `size` per vertex, or empty.
Quality quality_of(const Mesh& mesh, std::span<const int> opposite, const std::vector<double>& size);

/// How many values fall into each of n equal parts of [low, high]; the others are left out.
std::vector<int> bins(std::span<const float> values, double low, double high, int n);

/// A point of a surface where it leaves so little room that kappa of a triangle with that corner is 0.1 at
/// best: borders, and edges marked by bit i of `model`, less than 3 degrees apart, or none and 9 degrees all
/// round.
struct NeedleTip {
  Vec3 point;
  double room;  ///< radians, a third of what there is all round
};
std::vector<NeedleTip> needle_tips(const Mesh& mesh, std::span<const int> opposite,
                                   const std::vector<std::uint8_t>& model);

/// The triangles with kappa up to 0.1 that tips of the surface force to be so, as flags: joined to one by
/// others like them, and so near to it that the room there is narrower than they are long.
std::vector<char> forced_needles(const Mesh& mesh, const std::vector<float>& kappas,
                                 const std::vector<NeedleTip>& tips);

/// The smallest kappa of the triangles that do not touch, nor have a neighbour at a vertex that touches, a
/// vertex where two marked edges (bit i of `model`: edge i; borders always) meet at less than 40 degrees over
/// the surface: such a wedge leaves no room for good triangles. `worst` becomes the triangle, or -1.
double kappa_off_wedges(const Mesh& mesh, std::span<const int> opposite,
                        const std::vector<std::uint8_t>& model, const Quality& quality, int& worst);

/// The mesh that `mesh` was cut from: triangles of equal `origin` that are pieces of one become that one.
/// Points stay, some unused. Where pieces make no triangle (their area is not that of its corners), they
/// stay. Linear time. `now`, if not null: the triangle of the result that each of `mesh` has become or is a
/// piece of. Precondition: origin.size() == mesh.tris.size(), no origin is negative.
Mesh uncut(const Mesh& mesh, const std::vector<int>& origin, std::vector<int>* now = nullptr);

}  // namespace meshpipe
