// SPDX-License-Identifier: BSD-3-Clause
// What mcheck would find wrong with a mesh, and more; for lib/relax/ only.
#pragma once
#include "lib/core/bvh.h"
#include "lib/core/sectors.h"
#include "lib/core/topology.h"
#include "lib/relax/repair.h"

namespace meshpipe {

/// From where on a distance, in sizes, and a kappa are faults.
struct Limits {
  double distance, kappa;
};
constexpr Limits needed{rules::too_far, rules::failing_kappa},
    refused{rules::within_limit, rules::failing_kappa};  // by mcheck, which `needed` has a margin over

/// What was found of a mesh.
struct MeasuredMesh {
  IntersectingPairs intersections{};
  std::vector<double> walked{};    ///< per triangle, `deviation` as a length, at `time`
  std::vector<double> searched{};  ///< `distance_of` then, or -1
  int time = -1;
  int looked = -1;  ///< when long triangles of the reference were looked at
  double mean = 0;  ///< the largest mean size of all looks at this mesh
};

/// What is asked of mesh and reference more than once, computed when it is needed.
struct Known {
  const Surface& reference;
  Samples& samples;
  Limits limits = needed;
  MeasuredMesh of_mesh{};
  std::optional<Mesh> contacts{};     ///< where the reference before cuts intersects itself, and its chords
  std::optional<Bvh> contact_tree{};  ///< of these, if there are any
  bool looked_near = false;           ///< contacts were looked for near the first pairs
  std::optional<Bvh> built{};
  std::vector<char> corners{};

  const Bvh& tree() { return built ? *built : built.emplace(reference); }
  /// Returns per vertex of the reference whether feature edges or its surface are so sharp there that no
  /// triangle has kappa 0.1.
  const std::vector<char>& needle_corners() {
    if (corners.empty()) {
      const std::vector<int> opposite = opposite_halfedges(reference);
      const Connectivity surface{reference, opposite, model_of(reference)};
      corners.resize(reference.points.size());
      for (const Sector& sector : needle_sectors(surface)) corners[surface.from(sector.first)] = 1;
    }
    return corners;
  }
};

/// A place of the reference that is too far from the mesh, the triangle that may come nearer to it, and its
/// distance in sizes.
struct MissedPlace {
  int near;
  Vec3 at;
  double distance;
};

/// What is wrong: pairs and folds, and a sum of distances and 1/kappa over what is bearable.
struct Fault : Intersections {
  int folds = 0;
  std::vector<int> triangles;  ///< those at folds, those that are too far from the reference, and needles
  std::vector<MissedPlace> missed;
  int mild = 0;  ///< needles with less than rules::bearable_kappa that are within the limits
  double excess = 0;
  bool acceptable = true;  ///< to mcheck? Not if it was not looked for all that mcheck looks for

  bool none() const { return pairs.empty() && triangles.empty(); }
  int count() const { return (int)pairs.size() + folds; }
  double sum() const { return rules::pair_excess * count() + excess; }
  bool less_than(const Fault& other) const {
    return Faults{{}, count(), sum()}.less_than({{}, other.count(), other.sum()});
  }
};

/// Drops the pairs that only touch in copies of the same vertices.
void drop_contacts_of_sheets(const State& s, std::vector<std::pair<int, int>>& pairs);
/// Returns pairs of triangles of which one has a chord for an edge and the other lies along it.
std::vector<std::pair<int, int>> chords_of(const State& s);
/// Returns the edges, each by one half-edge, at which the mesh folds and the reference does not.
std::vector<int> folded_edges(const State& s, Known& known);
/// Returns the largest distance of triangle t from the reference that is found; it is not looked for where
/// all are at most `limit`. A walk may end on the wrong sheet, so it is searched for.
double distance_of(const State& s, int t, const Bvh& tree, double limit);
/// Returns how far triangle t and what is nearest to it may be apart, by this share of the size, whose mean
/// is `mean`.
double bearable_distance(const State& s, int t, double mean, double share = rules::too_far);
/// Returns whether the needle t, of kappa k, is no worse than the angle between two model edges at a corner
/// forces it to be. kappa of an isosceles triangle is 4 s (1 - s), s the sine of half the angle at its apex.
/// Where edges bend, the angle between long ones may be less than the model's, an excuse only if that is
/// sharp.
bool is_forced(const State& s, int t, double k, Known& known);
/// Returns all that is wrong by the limits of `known`.
Fault find_faults(const State& s, Known& known);

}  // namespace meshpipe
